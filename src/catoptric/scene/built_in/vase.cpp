// SPDX-License-Identifier: Apache-2.0
// A chrome vase: a surface of revolution whose belly is convex and whose waist is a saddle, hollow along its
// axis and round across it. On a terrace, with things at its foot.
#include "catoptric/geometry/polyhedra.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

constexpr double kTerrace = 6.0, kHeight = 1.15, kPlinth = 0.1;

/// Foot 0.26, belly 0.36, waist 0.2, lip 0.29 m.
geometry::RadiusSample profileAt(double y) {
  const double belly = (y - 0.36) / 0.36, lip = (y - 1.35) / 0.34;
  const double b = 0.19 * std::exp(-belly * belly), l = 0.17 * std::exp(-lip * lip);
  return {0.17 + b + l, -2 * b * belly / 0.36 - 2 * l * lip / 0.34};
}

void addVase(SceneBuilder& builder) {
  const double foot = profileAt(0).radius, lip = profileAt(kHeight).radius;
  builder.place("vase", geometry::makeRevolvedSide(kHeight, 144, 64, profileAt), builder.mirror("chrome"),
                moveBy({0, kPlinth + 0.002, 0}));
  builder.place("plinth", geometry::makeCylinder(foot + 0.05, kPlinth, 96),
                builder.paint("plinth", colour(0xB7AE9B), 0.7f), moveBy({0, 0.5 * kPlinth + 0.0005, 0}));
  const int earth = builder.paint("earth", colour(0x3B2A1E), 1.0f);
  builder.place("earth in the vase", geometry::makeDisc(lip - 0.001, 0, 64, true), earth,
                moveBy({0, kPlinth + kHeight, 0}));
  const std::vector<Piece> bush = makePottedPlant(builder, 0.9, 5);
  builder.place("bush in the vase", std::span(bush).subspan(3), moveBy({0, kPlinth + kHeight - 0.42, 0}));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("large block", makeToyBlock(builder, 0.34, "ABC", pine, colour(0x2B4FA0)),
                standAt({0.85, y, 0.45}, 29));
  builder.place("small block", makeToyBlock(builder, 0.22, "123", pine, colour(0xB8322A)),
                standAt({-0.3, y, 0.85}, -20));
  builder.place("red cone", geometry::makeCone(0.17, 0, 0.7, 48, true),
                builder.paint("red paint", colour(0xC2302A), 0.35f), standAt({-0.78, y, 0.42}));
  builder.place(
      "ball", geometry::makeUvSphere(0.17, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f),
      standAt({0.3, y + 0.17, 0.8}, 20));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x4E9A7C), 0.25f)),
                standAt({-1.1, y, -0.5}, 160, 0.4));
  builder.place("dodecahedron", geometry::makePolyhedron(geometry::Polyhedron::Dodecahedron, 0.28),
                builder.paint("violet paint", colour(0x7A4FA3), 0.4f),
                standAt({1.1, 0.224, -0.5}) * geometry::turnAround({1, 0, 0}, 0.5535744));
  const int pole = builder.addMesh("striped pole", makeStripedPole(builder, 1.3, 0.035));
  builder.place("pole 1", pole, standAt({-1.3, y, 1.2}));
  builder.place("pole 2", pole, standAt({1.3, y, 1.3}));
  const int plant = builder.addMesh("plant", makePottedPlant(builder, 1.15, 5));
  builder.place("plant 1", plant, standAt({1.9, y, 1.9}));
  builder.place("plant 2", plant, standAt({-2.0, y, 1.7}, 70));
  builder.place("traffic cone", makeTrafficCone(builder), standAt({0.4, y, 2.3}, 15));
}

}  // namespace

Scene makeVase() {
  SceneBuilder builder("vase");
  builder.addCamera("front", {0.3, 1.55, 2.4}, {0.0, 0.66, 0.05}, 42);
  builder.addCamera("above", {-1.2, 2.3, 1.5}, {0, 0.6, 0}, 45);
  BakedLight light;
  light.addColumn({0, 0, 0}, 0.27, 0.36, 0.5);
  light.addBox({0.85, 0.17, 0.45}, dvec3(0.34), 0.5);
  light.addBox({-0.3, 0.11, 0.85}, dvec3(0.22), -0.35);
  light.addColumn({-0.78, 0, 0.42}, 0.17, 0.01, 0.7);
  light.addBall({0.3, 0.17, 0.8}, 0.17);
  light.addBall({-1.1, 0.18, -0.5}, 0.24);
  light.addBall({1.1, 0.28, -0.5}, 0.28);
  light.addColumn({1.9, 0, 1.9}, 0.3, 0.3, 0.3);
  light.addColumn({-2.0, 0, 1.7}, 0.3, 0.3, 0.3);
  light.addColumn({-1.3, 0, 1.2}, 0.1, 0.04, 0.3);
  light.addColumn({1.3, 0, 1.3}, 0.1, 0.04, 0.3);
  light.setLamp({-4.5, 9, 4}, 1.0);
  addTerraceWithTrees(builder, kTerrace, light, tiles(colour(0xC7A98A), colour(0x6B5A48), 14, 4));
  addVase(builder);
  addThings(builder);
  builder.addSun({-4.5, 9, 4}, vec3(0.95f, 0.9f, 0.8f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
