// SPDX-License-Identifier: Apache-2.0
// Several reflecting polyhedra, every facet a flat mirror, and a reflecting sphere (Ofek & Rappoport 1998,
// figure 20).
#include "catoptric/geometry/polyhedra.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;
using geometry::Polyhedron;
using geometry::turnAround;

const dvec3 kRoomSize(6, 3, 5);

void addShell(SceneBuilder& builder) {
  BakedLight light;
  light.addBall({-0.75, 0.4, 0.05}, 0.36);  // dodecahedron
  light.addBall({0.72, 0.36, -0.2}, 0.32);  // sphere
  light.addColumn({0.05, 0, -0.75}, 0.1, 0.4, 0.4);
  light.addBox({0.05, 0.17, 0.52}, dvec3(0.34), 0.6);
  light.addColumn({1.45, 0, 0.55}, 0.2, 0.01, 0.55);
  light.addBox({-1.5, 0.15, 0.75}, dvec3(0.3), 0.3);
  light.addBox({0.62, 0.12, 0.95}, dvec3(0.24), -0.4);
  light.addBall({-0.55, 0.16, 1.05}, 0.16);
  light.setLamp({-1.4, 4.0, 1.8}, 0.6);
  const dvec2 half(0.5 * kRoomSize.x, 0.5 * kRoomSize.z);
  const auto baked = light.bake(-half, half, 0, 288, 240, 0.85, 0.4);
  const auto corners = edgeShade({kRoomSize.x, kRoomSize.z}, 0.3, 0.35);
  RoomOptions room;
  room.size = kRoomSize;
  const Pattern parquet = checker(colour(0xD9D3C4), colour(0x5E6B70), 12, 10);
  room.floor = builder.textured("floor tiles", {1024, 1024},
                                shaded(parquet, [=](dvec2 uv) { return baked(uv) * corners(uv); }), 0.5f, 1);
  room.walls = builder.textured("wall plaster", {512, 512}, plaster(colour(0xC4CBBF), 0.06, 8), 0.9f, 1);
  room.ceiling = builder.paint("ceiling", colour(0xE9E6DF), 0.95f);
  const int white = room.skirting = builder.paint("white paint", colour(0xECE9E2), 0.5f);
  const Opening windows[] = {{{0.6, 0.9}, {2.0, 2.4}}, {{3.0, 0.9}, {4.4, 2.4}}},
                rear{{1.6, 0.7}, {4.4, 2.4}};
  room.openings[kRight] = {windows[0], windows[1]};
  room.openings[kFront] = {rear};
  addRoom(builder, room);
  addWindow(builder, "window 1", kRoomSize, kRight, windows[0], white, 1, 1);
  addWindow(builder, "window 2", kRoomSize, kRight, windows[1], white, 1, 1);
  addWindow(builder, "rear window", kRoomSize, kFront, rear, white, 2, 1);
  const int frame = builder.paint("picture frame", colour(0x2E2A26), 0.4f);
  addPicture(builder, "abstract", kRoomSize, kBack, {{0.9, 1.0}, {2.0, 2.3}},
             builder.textured("abstract", {256, 512}, abstractPainting(), 0.5f), frame);
  addPicture(builder, "landscape", kRoomSize, kBack, {{3.1, 1.1}, {4.9, 2.2}},
             builder.textured("landscape", {512, 256}, landscapePainting(), 0.5f), frame);
}

void addMirrors(SceneBuilder& builder) {
  const int silver = builder.mirror("silver", vec3(0.94f)),
            gold = builder.mirror("gold", vec3(0.97f, 0.88f, 0.72f));
  const int copper = builder.mirror("copper", vec3(0.96f, 0.82f, 0.74f)),
            steel = builder.mirror("blue steel", vec3(0.82f, 0.89f, 0.96f));
  // The dodecahedron lies on a facet: 31.7 degrees from the corner axis of its usual frame; in-radius 0.7947
  // R.
  builder.place("dodecahedron", geometry::makePolyhedron(Polyhedron::Dodecahedron, 0.44), silver,
                moveBy({-0.75, 0.7946545 * 0.44 + 0.001, 0.05}) * turnAround({0, 1, 0}, 0.35) *
                    turnAround({1, 0, 0}, 0.5535744));
  builder.place("octahedron", geometry::makePolyhedron(Polyhedron::Octahedron, 0.46), gold,
                moveBy({0.05, 0.462, -0.75}) * turnAround({0, 1, 0}, 0.3));
  builder.place("cube", geometry::makePolyhedron(Polyhedron::Cube, 0.17 * std::sqrt(3.0)), copper,
                moveBy({0.05, 0.171, 0.52}) * turnAround({0, 1, 0}, 0.6));
  builder.place("sphere", geometry::makeIcosphere(0.34, 24), steel, moveBy({0.72, 0.341, -0.2}));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("cone", geometry::makeCone(0.2, 0, 0.55, 40, true),
                builder.paint("orange paint", colour(0xE8761C), 0.35f), standAt({1.45, y, 0.55}));
  builder.place("block 1", makeToyBlock(builder, 0.3, "ABC", pine, colour(0xB8322A)),
                standAt({-1.5, y, 0.75}, 17));
  builder.place("block 2", makeToyBlock(builder, 0.24, "123", pine, colour(0x2E7A45)),
                standAt({0.62, y, 0.95}, -23));
  builder.place(
      "ball", geometry::makeUvSphere(0.16, 32, 16),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f, 2),
      standAt({-0.55, y + 0.16, 1.05}, 30));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0xB24A3A), 0.25f)),
                standAt({-0.15, y, 1.35}, 40, 0.32));
  builder.place("sofa", makeSofa(builder, colour(0x3E5F7A)), standAt({-1.9, y, 1.75}, 150));
  builder.place("chair", makeChair(builder), standAt({2.1, y, -0.9}, -60));
  builder.place("plant", makePottedPlant(builder, 1.5, 8), standAt({-2.4, y, -1.9}));
  builder.place("ring", geometry::makeTorus(0.16, 0.05, 40, 16),
                builder.paint("violet paint", colour(0x7A4FA3), 0.35f), standAt({1.15, y + 0.05, 1.3}));
}

}  // namespace

Scene makePolyhedraAndSphere() {
  SceneBuilder builder("polyhedra-and-sphere");
  builder.addCamera("front", {0.35, 1.25, 2.25}, {-0.02, 0.42, 0.05}, 46);
  addShell(builder);
  addMirrors(builder);
  addThings(builder);
  builder.addLamp({-1.4, 2.6, 1.8}, vec3(2.2f, 2.1f, 1.9f));
  builder.addLamp({1.8, 2.5, -0.8}, vec3(1.2f, 1.2f, 1.25f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
