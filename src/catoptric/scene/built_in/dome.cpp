// SPDX-License-Identifier: Apache-2.0
// Two mirrors that are neither spheres nor quadrics but have an equation: an aspheric dome on a wall, nearly
// flat in the middle so that faces keep their shape and bent more towards its rim so that the whole room is
// seen, and a chrome barrel of two radii, a piece of a torus.
#include "catoptric/geometry/convex_edges.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(4.8, 2.6, 4.6);
constexpr double kBack = -2.12, kTable = 0.74, kOnTable = kTable + 0.0026;
const dvec3 kDome(-0.35, 1.42, kBack), kBarrel(0.52, kOnTable, -1.3);
constexpr double kOpening = 0.45;  // of the dome, metres
// Its equation, z = c r^2 / (1 + sqrt(1 - c^2 r^2)) + a4 r^4 + a6 r^6.
constexpr double kCurvature = -1 / 1.2, kFourth = -0.55, kSixth = -0.4;
constexpr double kBarrelHeight = 0.52, kBelly = 0.17, kStave = 0.5;  // the barrel's two radii, metres

geometry::HeightSample domeAt(dvec2 p) {
  const double u = glm::dot(p, p), root = std::sqrt(1 - kCurvature * kCurvature * u);
  const double slope = kCurvature / root + 4 * kFourth * u + 6 * kSixth * u * u;  // over r
  return {kCurvature * u / (1 + root) + u * u * (kFourth + kSixth * u), slope * p.x, slope * p.y};
}

/// A square onto a disc along the rays from its middle.
dvec2 discFromSquare(dvec2 s) {
  const double length = glm::length(s), edge = std::max(std::abs(s.x), std::abs(s.y));
  return length > 0 ? s * (kOpening * edge / length) : s;
}

geometry::RadiusSample barrelAt(double y) {
  const double along = y - 0.5 * kBarrelHeight, root = std::sqrt(kStave * kStave - along * along);
  return {kBelly - kStave + root, -along / root};
}

void addMirrors(SceneBuilder& builder) {
  const int chrome = builder.mirror("chrome", vec3(0.93f, 0.94f, 0.95f));
  const double rim = domeAt({kOpening, 0}).z;
  builder.place("dome", geometry::withConvexEdges(geometry::makeHeightField(64, 64, discFromSquare, domeAt)),
                chrome, moveBy(kDome - dvec3(0, 0, rim)));
  builder.place("rim", geometry::makeTorus(kOpening + 0.016, 0.018, 96, 16),
                builder.metal("brass", colour(0xC9A24B), 0.35f),
                moveBy(kDome) * geometry::turnAround({1, 0, 0}, 1.5707963267948966));
  builder.place("barrel", geometry::makeRevolvedSide(kBarrelHeight, 144, 32, barrelAt), chrome,
                moveBy(kBarrel + dvec3(0, 0.012, 0)));
  const int paint = builder.paint("brass paint", colour(0xC9A24B), 0.35f);
  const double end = barrelAt(0).radius;
  builder.place("foot", geometry::makeCylinder(end + 0.01, 0.011, 96), paint,
                moveBy(kBarrel + dvec3(0, 0.0055, 0)));
  builder.place("lid", geometry::makeCylinder(end + 0.01, 0.012, 96), paint,
                moveBy(kBarrel + dvec3(0, kBarrelHeight + 0.0185, 0)));
}

void addThings(SceneBuilder& builder) {
  builder.place("table", makeTable(builder, {1.9, kTable, 1.0}, furnitureWood(builder)),
                standAt({0, 0.002, -1.2}));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("red block", makeToyBlock(builder, 0.12, "ABC", pine, colour(0xB8322A)),
                standAt({0.2, kOnTable, -0.98}, 24));
  builder.place("blue block", makeToyBlock(builder, 0.1, "123", pine, colour(0x2B4FA0)),
                standAt({0.72, kOnTable, -0.92}, -18));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f)),
                standAt({-0.3, kOnTable, -1.25}, -30, 0.17));
  builder.place("orange cone", geometry::makeCone(0.05, 0, 0.18, 32, true),
                builder.paint("orange paint", colour(0xE8761C), 0.4f), standAt({0.47, kOnTable, -0.9}));
  builder.place("globe", makeGlobe(builder), standAt({-0.72, kOnTable, -1.2}, 40, 0.9));
  const int chair = builder.addMesh("chair", makeChair(builder));
  builder.place("chair 1", chair, standAt({1.35, 0.002, 0.1}, -140));
  builder.place("chair 2", chair, standAt({-1.3, 0.002, 0.4}, 150));
  builder.place("sofa", makeSofa(builder, colour(0x3F5A44)), standAt({-0.4, 0.002, 1.85}, 180));
  builder.place("plant", makePottedPlant(builder, 1.5, 3), standAt({1.9, 0.002, 1.6}));
  builder.place("bookshelf", makeBookshelf(builder, {1.0, 1.8, 0.3}, 5), standAt({-2.2, 0.002, 0.6}, 90));
  builder.place("pole", makeStripedPole(builder, 1.3, 0.035), standAt({-0.9, 0.002, -0.3}));
}

}  // namespace

Scene makeDome() {
  SceneBuilder builder("dome");
  builder.addCamera("front", {0.3, 1.6, 0.7}, {0.0, 1.17, -1.7}, 42);
  builder.addCamera("near", {-0.1, 1.5, -0.75}, kDome, 60);
  BakedLight light;
  light.addBox({0, kTable - 0.03, -1.2}, {1.9, 0.05, 1.0});
  light.addBox({1.35, 0.3, 0.1}, {0.45, 0.5, 0.45}, 0.7);
  light.addBox({-1.3, 0.3, 0.4}, {0.45, 0.5, 0.45}, 0.5);
  light.addBox({-0.4, 0.3, 1.85}, {1.6, 0.5, 0.8});
  light.addColumn({-0.9, 0, -0.3}, 0.1, 0.04, 0.3);
  light.addColumn({1.9, 0, 1.6}, 0.3, 0.3, 0.4);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xB4BFCB), colour(0xC79D6A), colour(0x93673C)});
  addMirrors(builder);
  addThings(builder);
  builder.addLamp({-1.3, 2.3, 0.9}, vec3(1.6f, 1.5f, 1.35f));
  builder.addLamp({1.3, 2.3, -0.4}, vec3(1.2f, 1.15f, 1.05f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
