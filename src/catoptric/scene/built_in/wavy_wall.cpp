// SPDX-License-Identifier: Apache-2.0
// A wall of wavy chrome, as at a fair: crest after trough, an extrusion of mixed convexity. In each trough
// what is near is enlarged and what is far is reversed.
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

constexpr double kTerrace = 7.0, kWaves = 2.5, kCrestRadius = 1.3;
const dvec2 kHalf(1.6, 0.85);
const dvec3 kCentre(0, 1.0, -1.2);

geometry::HeightSample wallAt(dvec2 p) {
  const double k = 3.141592653589793 * kWaves / kHalf.x, a = 1 / (kCrestRadius * k * k);
  return {a * std::cos(k * p.x), -a * k * std::sin(k * p.x), 0};
}

void addWall(SceneBuilder& builder) {
  const auto place = [](dvec2 s) { return kHalf * s; };
  builder.place("wavy mirror", geometry::makeHeightField(180, 24, place, wallAt), builder.mirror("chrome"),
                moveBy(kCentre));
  builder.place("frame", makeFrame(2.0 * kHalf + 0.004, 0.07, 0.13),
                builder.paint("frame", colour(0xB3322A), 0.5f), moveBy(kCentre - dvec3(0, 0, 0.06)));
  builder.place("back board", geometry::makeBox({2 * kHalf.x + 0.14, 2 * kHalf.y + 0.14, 0.02}),
                builder.paint("board", colour(0x4A5A6B), 0.8f), moveBy(kCentre - dvec3(0, 0, 0.075)));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  const vec3 pine = colour(0xE8D3A6);
  const int cone = builder.addMesh("traffic cone", makeTrafficCone(builder));
  builder.place("traffic cone 1", cone, standAt({-1.0, y, -0.35}, 12));
  builder.place("traffic cone 2", cone, standAt({0.85, y, 0.6}, 40));
  builder.place("large block", makeToyBlock(builder, 0.36, "ABC", pine, colour(0x2B4FA0)),
                standAt({-0.35, y, -0.3}, 25));
  builder.place("small block", makeToyBlock(builder, 0.26, "DEF", pine, colour(0xB8322A)),
                standAt({0.3, y, -0.6}, -20));
  builder.place(
      "ball", geometry::makeUvSphere(0.22, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f),
      standAt({1.15, y + 0.22, -0.5}, 20));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0xC77A2C), 0.25f)),
                standAt({-1.5, y, 0.9}, 30, 0.5));
  builder.place("chair", makeChair(builder), standAt({-1.85, y, -0.1}, 60));
  const int pole = builder.addMesh("striped pole", makeStripedPole(builder, 1.5, 0.04));
  builder.place("pole 1", pole, standAt({-0.75, y, 0.5}));
  builder.place("pole 2", pole, standAt({1.8, y, 0.7}));
  const int plant = builder.addMesh("plant", makePottedPlant(builder, 1.3, 5));
  builder.place("plant 1", plant, standAt({2.3, y, 2.2}));
  builder.place("plant 2", plant, standAt({-2.4, y, 1.9}, 70));
}

}  // namespace

Scene makeWavyWall() {
  SceneBuilder builder("wavy-wall");
  builder.addCamera("front", {0.35, 1.6, 2.7}, {0.0, 0.82, -1.0}, 46);
  builder.addCamera("left", {-2.3, 1.3, 1.0}, {-0.1, 0.85, -1.0}, 54);
  BakedLight light;
  light.addBox({0, 0.95, -1.26}, {3.3, 1.9, 0.16});
  light.addColumn({-1.0, 0, -0.35}, 0.17, 0.03, 0.7);
  light.addColumn({0.85, 0, 0.6}, 0.17, 0.03, 0.7);
  light.addBox({-0.35, 0.18, -0.3}, dvec3(0.36), 0.44);
  light.addBox({0.3, 0.13, -0.6}, dvec3(0.26), -0.35);
  light.addBall({1.15, 0.22, -0.5}, 0.22);
  light.addBall({-1.5, 0.22, 0.9}, 0.26);
  light.addBox({-1.85, 0.3, -0.1}, {0.45, 0.5, 0.45}, 1.0);
  light.addColumn({-0.75, 0, 0.5}, 0.12, 0.04, 0.3);
  light.addColumn({1.8, 0, 0.7}, 0.12, 0.04, 0.3);
  light.addColumn({2.3, 0, 2.2}, 0.32, 0.32, 0.36);
  light.addColumn({-2.4, 0, 1.9}, 0.32, 0.32, 0.36);
  light.setLamp({-4.5, 9, 5}, 1.0);
  addTerraceWithTrees(builder, kTerrace, light, checker(colour(0xD9CFBC), colour(0x8C4B34), 14, 14));
  addWall(builder);
  addThings(builder);
  builder.addSun({-4.5, 9, 5}, vec3(0.95f, 0.9f, 0.8f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
