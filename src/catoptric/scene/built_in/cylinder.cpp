// SPDX-License-Identifier: Apache-2.0
// An upright chrome cylinder on a patterned floor with coloured things around it (Ofek & Rappoport 1998,
// figure 12). Its smooth side is the mirror, its caps are painted.
#include "catoptric/geometry/polyhedra.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

constexpr double kRadius = 0.42, kHeight = 1.25, kPlinth = 0.06;
constexpr double kTerrace = 6.4;  // edge of the square floor

struct Thing {
  const char* name;
  double x, z, turn;
};

BakedLight terraceLight() {
  BakedLight light;
  light.addColumn({0, 0, 0}, kRadius, kRadius, kHeight);
  light.addColumn({-0.95, 0, 0.7}, 0.2, 0.0, 0.62);    // cone
  light.addBox({0.98, 0.19, 0.62}, dvec3(0.38), 0.5);  // block
  light.addBox({-0.42, 0.14, 1.2}, dvec3(0.28), -0.35);
  light.addBall({0.38, 0.2, 1.12}, 0.2);
  light.addBall({-1.15, 0.2, -0.45}, 0.26);
  light.addBall({1.25, 0.3, -0.4}, 0.3);
  light.addColumn({1.7, 0, 1.4}, 0.3, 0.3, 0.3);
  light.addColumn({-1.9, 0, 1.5}, 0.3, 0.3, 0.3);
  light.setLamp({-4.5, 9, 4}, 1.0);
  return light;
}

Pattern terraceFloor() {
  const Pattern field = checker(colour(0xD8C9A8), colour(0x8C4B34), 8, 8);
  const Pattern border = tiles(colour(0x4D6B78), colour(0xB8B2A4), 16, 4);
  const Pattern star = tiles(colour(0xC9A557), colour(0x5C4A2E), 8, 6);
  return [=](dvec2 uv) {
    const dvec2 p = glm::abs(uv - 0.5) * kTerrace;
    const double edge = std::max(p.x, p.y), round = glm::length(p);
    if (edge > 2.56) return border(uv);
    if (round < 0.72)
      return round < 0.64 && round > 0.56 ? colour(0xC9A557)
             : round < 0.56               ? star(uv * 4.0)
                                          : colour(0x3A3430);
    return field((uv - 0.5) * (kTerrace / 5.12) + 0.5);
  };
}

void addTerrace(SceneBuilder& builder) {
  const double h = 0.5 * kTerrace;
  const auto light = terraceLight().bake(dvec2(-h), dvec2(h), 0, 256, 256, 0.8, 0.4);
  const auto corners = edgeShade(dvec2(kTerrace), 0.2, 0.3);
  const int floor =
      builder.textured("terrace floor", {1024, 1024},
                       shaded(terraceFloor(), [=](dvec2 uv) { return light(uv) * corners(uv); }), 0.6f, 2);
  builder.placeShell("floor", geometry::makePlane(kTerrace, kTerrace, 2, 2), floor);
  const int brick =
      builder.textured("brick", {512, 512}, bricks(colour(0xA8573B), colour(0xB9AE9C), 4, 8, 12), 0.85f, 2);
  const int stone = builder.paint("coping", colour(0xC9C0AE), 0.8f);
  const dvec3 room(kTerrace, 0.8, kTerrace);
  constexpr const char* kNames[] = {"back parapet", "front parapet", "left parapet", "right parapet"};
  for (const Wall wall : {kBack, kFront, kLeft, kRight}) {
    const dmat4 place = worldFromWall(room, wall);
    builder.placeShell(kNames[wall], makeWall({kTerrace, 0.8}, {}, 1.0), brick, place);
    builder.placeShell(std::string(kNames[wall]) + " coping", geometry::makeBox({kTerrace, 0.07, 0.28}),
                       stone, place * geometry::moveBy({0.5 * kTerrace, 0.836, -0.13}));
  }
}

void addColumn(SceneBuilder& builder) {
  using geometry::moveBy;
  const int cap = builder.paint("cap", colour(0x33363A), 0.5f),
            stone = builder.paint("plinth", colour(0xB7AE9B), 0.7f);
  const Piece pieces[] = {
      {geometry::makeCylinderSide(kRadius, kHeight, 144, 12, false), builder.mirror("chrome")},
      {geometry::makeDisc(kRadius, 0.5 * kHeight, 144, true), cap},
      {geometry::makeDisc(kRadius, -0.5 * kHeight, 144, false), cap}};
  builder.place("chrome cylinder", pieces, moveBy({0, kPlinth + 0.001 + 0.5 * kHeight, 0}));
  builder.place("plinth", geometry::makeCylinder(kRadius + 0.06, kPlinth - 0.001, 96), stone,
                moveBy({0, 0.5 * kPlinth + 0.0005, 0}));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  builder.place("red cone", geometry::makeCone(0.2, 0, 0.62, 48, true),
                builder.paint("red paint", colour(0xC2302A), 0.35f), standAt({-0.95, y, 0.7}));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("large block", makeToyBlock(builder, 0.38, "ABC", pine, colour(0x2B4FA0)),
                standAt({0.98, y, 0.62}, 29));
  builder.place("small block", makeToyBlock(builder, 0.28, "123", pine, colour(0x2E7A45)),
                standAt({-0.42, y, 1.2}, -20));
  builder.place(
      "ball", geometry::makeUvSphere(0.2, 40, 20),
      builder.textured("ball", {256, 128},
                       repeated(stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), {1, 1}), 0.35f, 2),
      standAt({0.38, y + 0.2, 1.12}, 20));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x4E9A7C), 0.25f)),
                standAt({-1.15, y, -0.45}, 160, 0.45));
  builder.place("dodecahedron", geometry::makePolyhedron(geometry::Polyhedron::Dodecahedron, 0.3),
                builder.paint("violet paint", colour(0x7A4FA3), 0.4f),
                standAt({1.25, 0.24, -0.4}) * geometry::turnAround({1, 0, 0}, 0.5535744));
  const int plant = builder.addMesh("plant", makePottedPlant(builder, 1.15, 5));
  builder.place("plant 1", plant, standAt({1.7, y, 1.4}));
  builder.place("plant 2", plant, standAt({-1.9, y, 1.5}, 70));
  builder.place("cones behind", makeTrafficCone(builder), standAt({0.2, y, 2.3}, 15));
}

void addTrees(SceneBuilder& builder) {
  const int tree = builder.addMesh("tree", makeTree(builder, 4.2, 2));
  const dvec3 places[] = {{-5, -0.2, -6},   {4.5, -0.2, -7}, {-6.5, -0.2, 2},
                          {6.5, -0.2, 3.5}, {-3, -0.2, 7},   {2.5, -0.2, 8}};
  int count = 0;
  for (const dvec3& place : places) {
    builder.place("tree " + std::to_string(count + 1), tree,
                  standAt(place, 70.0 * count, 0.85 + 0.08 * count));
    ++count;
  }
}

}  // namespace

Scene makeCylinder() {
  SceneBuilder builder("cylinder");
  builder.addCamera("front", {0.3, 1.72, 2.5}, {0.0, 0.58, 0.05}, 42);
  builder.addCamera("above", {1.2, 2.3, 1.6}, {0, 0.5, 0}, 45);
  addTerrace(builder);
  addTrees(builder);
  addColumn(builder);
  addThings(builder);
  builder.addSun({-4.5, 9, 4}, vec3(0.95f, 0.9f, 0.8f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
