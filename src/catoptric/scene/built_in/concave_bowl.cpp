// SPDX-License-Identifier: Apache-2.0
// A concave bowl on a wall (Ofek & Rappoport 1998, figures 8 and 11). What stands on the table in front of it
// lies before the focus and is seen enlarged and upright (region A); the room lies behind the focus and is
// seen upside down (region B). Nothing stands where the focal surface is (region C).
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(4.8, 2.6, 4.6);
constexpr double kCurvatureRadius = 1.5, kOpening = 0.55;  // metres; seen from 3 m the focus is at about 1 m
constexpr double kTable = 0.98, kBack = -2.06;             // height of the table, z of the bowl's rim
const dvec3 kCentre(0, 1.4, kBack);

/// A square onto a disc along the rays from its middle.
dvec2 discFromSquare(dvec2 s) {
  const double length = glm::length(s), edge = std::max(std::abs(s.x), std::abs(s.y));
  return length > 0 ? s * (kOpening * edge / length) : s;
}

void addBowl(SceneBuilder& builder) {
  const double rim = std::sqrt(kCurvatureRadius * kCurvatureRadius - kOpening * kOpening);
  const auto height = [=](dvec2 p) {
    const double root = std::sqrt(kCurvatureRadius * kCurvatureRadius - glm::dot(p, p));
    return geometry::HeightSample{rim - root, p.x / root, p.y / root};
  };
  builder.place("bowl", geometry::makeHeightField(64, 64, discFromSquare, height), builder.mirror("chrome"),
                moveBy(kCentre));
  builder.place("rim", geometry::makeTorus(kOpening + 0.018, 0.018, 96, 16),
                builder.metal("brass", colour(0xC9A24B), 0.35f),
                moveBy(kCentre) * geometry::turnAround({1, 0, 0}, 1.5707963267948966));
}

void addTable(SceneBuilder& builder) {
  const double z = kBack + 0.3, y = kTable + 0.0035;
  builder.place("table", makeTable(builder, {1.7, kTable, 0.4}, furnitureWood(builder)),
                standAt({0, 0.002, z}));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("red block", makeToyBlock(builder, 0.13, "ABC", pine, colour(0xB8322A)),
                standAt({-0.25, y, z}, 24));
  builder.place("blue block", makeToyBlock(builder, 0.1, "123", pine, colour(0x2B4FA0)),
                standAt({0.26, y, z - 0.03}, -18));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f)),
                standAt({0.02, y, z}, -30, 0.17));
  builder.place("cone", geometry::makeCone(0.05, 0, 0.16, 32, true),
                builder.paint("orange paint", colour(0xE8761C), 0.4f), standAt({0.62, y, z}));
  builder.place("globe", makeGlobe(builder), standAt({-0.66, y, z}, 40));
}

void addRoomThings(SceneBuilder& builder) {
  const int chair = builder.addMesh("chair", makeChair(builder));
  builder.place("chair 1", chair, standAt({1.15, 0.002, 0.1}, -140));
  builder.place("chair 2", chair, standAt({-1.25, 0.002, 0.4}, 150));
  builder.place("sofa", makeSofa(builder, colour(0x7A3B3B)), standAt({-0.5, 0.002, 1.85}, 180));
  builder.place("plant", makePottedPlant(builder, 1.5, 3), standAt({1.9, 0.002, 1.6}));
  builder.place("bookshelf", makeBookshelf(builder, {1.0, 1.8, 0.3}, 5), standAt({-2.38, 0.002, -1.3}, 90));
  builder.place("pole", makeStripedPole(builder, 1.3, 0.035), standAt({-0.55, 0.002, 0.1}));
  builder.place(
      "ball", geometry::makeUvSphere(0.17, 40, 20),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f),
      standAt({0.5, 0.172, -0.3}, 25));
}

}  // namespace

Scene makeConcaveBowl() {
  SceneBuilder builder("concave-bowl");
  builder.addCamera("front", {0.25, 1.55, 0.75}, {0.0, 1.3, kBack}, 32);
  builder.addCamera("near", {-0.3, 1.55, -0.55}, {0.0, 1.3, kBack}, 54);
  BakedLight light;
  light.addBox({0, kTable - 0.03, kBack + 0.3}, {1.7, 0.05, 0.4});
  light.addBox({1.15, 0.3, 0.1}, {0.45, 0.5, 0.45}, 0.7);
  light.addBox({-1.25, 0.3, 0.4}, {0.45, 0.5, 0.45}, 0.5);
  light.addBox({-0.5, 0.3, 1.85}, {1.6, 0.5, 0.8});
  light.addBall({0.5, 0.17, -0.3}, 0.17);
  light.addColumn({-0.55, 0, 0.1}, 0.1, 0.04, 0.3);
  light.addColumn({1.9, 0, 1.6}, 0.3, 0.3, 0.4);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xB9C7C2), colour(0xC79D6A), colour(0x93673C)});
  addBowl(builder);
  addTable(builder);
  addRoomThings(builder);
  builder.addLamp({-1.3, 2.3, 0.9}, vec3(1.6f, 1.5f, 1.35f));
  builder.addLamp({1.3, 2.3, -0.4}, vec3(1.2f, 1.15f, 1.05f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
