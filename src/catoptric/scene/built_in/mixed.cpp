// SPDX-License-Identifier: Apache-2.0
// A reflector of mixed convexity (Ofek & Rappoport 1998, figure 9): its left half bulges, its right half is
// hollow, and the two join smoothly. z = a sin(k x) (1 - b y^2).
#include "catoptric/geometry/polyhedra.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

constexpr double kTerrace = 6.0;
const dvec2 kHalf(0.95, 0.55);
const dvec3 kCentre(0, 0.68, -0.5);

/// The radius of curvature is 1.5 m at the crest and in the trough: seen from 3 m, focus at about 1 m.
geometry::HeightSample sheetAt(dvec2 p) {
  const double k = 3.141592653589793 / kHalf.x, a = 1 / (1.5 * k * k), b = 0.9;
  const double wave = -std::sin(k * p.x), fade = 1 - b * p.y * p.y;
  return {a * wave * fade, -a * k * std::cos(k * p.x) * fade, -2 * a * b * p.y * wave};
}

void addSheet(SceneBuilder& builder) {
  const auto place = [](dvec2 s) { return kHalf * s; };
  builder.place("mixed mirror", geometry::makeHeightField(96, 56, place, sheetAt), builder.mirror("chrome"),
                moveBy(kCentre));
  constexpr double kDepth = 0.17;
  builder.place("frame", makeFrame(2.0 * kHalf + 0.004, 0.06, kDepth),
                builder.paint("frame", colour(0x2E3B36), 0.5f), moveBy(kCentre - dvec3(0, 0, 0.085)));
  builder.place("back board", geometry::makeBox({2 * kHalf.x + 0.12, 2 * kHalf.y + 0.12, 0.02}),
                builder.paint("board", colour(0x6B5B45), 0.8f), moveBy(kCentre - dvec3(0, 0, 0.1)));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("large block", makeToyBlock(builder, 0.3, "ABC", pine, colour(0x2B4FA0)),
                standAt({-0.62, y, 0.1}, 25));
  builder.place("small block", makeToyBlock(builder, 0.2, "123", pine, colour(0xB8322A)),
                standAt({0.62, y, -0.15}, -20));
  builder.place("red cone", geometry::makeCone(0.13, 0, 0.46, 48, true),
                builder.paint("red paint", colour(0xC2302A), 0.35f), standAt({0.32, y, -0.12}));
  builder.place(
      "ball", geometry::makeUvSphere(0.15, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f),
      standAt({-0.2, y + 0.15, 0.0}, 20));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x4E9A7C), 0.25f)),
                standAt({-1.3, y, 0.9}, 30, 0.4));
  builder.place("dodecahedron", geometry::makePolyhedron(geometry::Polyhedron::Dodecahedron, 0.25),
                builder.paint("violet paint", colour(0x7A4FA3), 0.4f),
                standAt({1.45, 0.2, 0.9}) * geometry::turnAround({1, 0, 0}, 0.5535744));
  const int plant = builder.addMesh("plant", makePottedPlant(builder, 1.15, 5));
  builder.place("plant 1", plant, standAt({1.9, y, 1.9}));
  builder.place("plant 2", plant, standAt({-2.0, y, 1.7}, 70));
  builder.place("pole", makeStripedPole(builder, 1.3, 0.035), standAt({1.15, y, 0.35}));
  const int cone = builder.addMesh("traffic cone", makeTrafficCone(builder));
  builder.place("traffic cone 1", cone, standAt({-0.6, y, 2.4}, 15));
  builder.place("traffic cone 2", cone, standAt({1.1, y, 2.5}, 40));
}

}  // namespace

Scene makeMixed() {
  SceneBuilder builder("mixed");
  builder.addCamera("front", {0.25, 1.4, 2.1}, {0.0, 0.56, -0.35}, 44);
  builder.addCamera("left", {-1.7, 1.1, 1.0}, {0, 0.6, -0.4}, 52);
  BakedLight light;
  light.addBox({0, 0.68, -0.55}, {2.0, 1.2, 0.16});
  light.addBox({-0.62, 0.15, 0.1}, dvec3(0.3), 0.44);
  light.addBox({0.62, 0.1, -0.15}, dvec3(0.2), -0.35);
  light.addColumn({0.32, 0, -0.12}, 0.13, 0.01, 0.46);
  light.addBall({-0.2, 0.15, 0}, 0.15);
  light.addBall({-1.3, 0.18, 0.9}, 0.22);
  light.addBall({1.45, 0.25, 0.9}, 0.25);
  light.addColumn({1.9, 0, 1.9}, 0.3, 0.3, 0.3);
  light.addColumn({-2.0, 0, 1.7}, 0.3, 0.3, 0.3);
  light.addColumn({1.15, 0, 0.35}, 0.1, 0.04, 0.3);
  light.setLamp({-4.5, 9, 4}, 1.0);
  addTerraceWithTrees(builder, kTerrace, light, checker(colour(0xD8CDB4), colour(0x4F6D5A), 12, 12));
  addSheet(builder);
  addThings(builder);
  builder.addSun({-4.5, 9, 4}, vec3(0.95f, 0.9f, 0.8f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
