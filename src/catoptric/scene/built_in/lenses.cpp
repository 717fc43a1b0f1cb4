// SPDX-License-Identifier: Apache-2.0
// A glass ball, a free-form lens and a block of green glass on a desk: light goes through curved surfaces
// twice, bent at each (Ofek & Rappoport 1998 name refraction as what their virtual objects should do, too).
#include <cmath>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(4.8, 2.6, 4.6);
constexpr double kDesk = 0.76, kBall = 0.14;
constexpr double kLensRadius = 0.17, kLensEdge = 0.012;  // half the thickness at the edge
constexpr int kLensCells = 48;

int makeGlass(SceneBuilder& builder, const std::string& name, float ior, const vec3& tint, float distance) {
  const int glass = builder.paint(name, vec3(1.0f), 0.0f);
  Material& m = builder.material(glass);
  m.transmission = 1.0f;
  m.thickness = 0.1f;
  m.ior = ior;
  m.attenuationColor = tint;
  m.attenuationDistance = distance;
  return glass;
}

/// A square onto a disc; the points of an edge lie at equal angles (Shirley & Chiu 1997).
dvec2 discFromSquare(dvec2 s) {
  constexpr double kQuarter = 0.78539816339744831;
  if (s.x == 0 && s.y == 0) return s;
  const bool isAcross = std::abs(s.x) > std::abs(s.y);
  const double radius = kLensRadius * (isAcross ? s.x : s.y);
  const double angle = isAcross ? kQuarter * s.y / s.x : 2 * kQuarter - kQuarter * s.x / s.y;
  return radius * dvec2(std::cos(angle), std::sin(angle));
}

/// A lens face: a bulge of which `twist` makes a free-form surface; flat against the edge's height all round.
geometry::Mesh makeLensFace(double bulge, double twist) {
  return geometry::makeHeightField(kLensCells, kLensCells, discFromSquare, [=](dvec2 p) {
    const dvec2 q = p / kLensRadius;
    const double inner = 1 - glm::dot(q, q);
    const double form = bulge + twist * (q.x * q.x * q.x - 2 * q.x * q.y * q.y + 0.7 * q.x * q.y);
    const dvec2 slope = twist * dvec2(3 * q.x * q.x - 2 * q.y * q.y + 0.7 * q.y, -4 * q.x * q.y + 0.7 * q.x);
    const dvec2 total = (inner * slope - 2.0 * q * form) / kLensRadius;
    return geometry::HeightSample{kLensEdge + inner * form, total.x, total.y};
  });
}

geometry::Mesh makeLens() {
  const dmat4 turned = geometry::turnAround({0, 1, 0}, glm::pi<double>());
  const dmat4 upright = geometry::turnAround({1, 0, 0}, 0.5 * glm::pi<double>());
  geometry::Mesh lens = makeLensFace(0.018, 0.013);
  geometry::append(lens, geometry::transformed(makeLensFace(0.012, 0.008), turned));
  geometry::append(
      lens, geometry::transformed(
                geometry::makeCylinderSide(kLensRadius, 2 * kLensEdge, 4 * kLensCells, 1, false), upright));
  return lens;
}

void addGlass(SceneBuilder& builder) {
  const double y = kDesk + 0.0035;
  const int brass = builder.metal("brass", colour(0xC9A24B), 0.35f);
  builder.place("glass ball", geometry::makeIcosphere(kBall, 25),
                makeGlass(builder, "crown glass", 1.52f, vec3(1.0f), 0.0f),
                moveBy({-0.36, y + 0.03 + kBall, 0.1}));
  builder.place("ring of the ball", geometry::makeTorus(0.07, 0.016, 48, 12), brass,
                moveBy({-0.36, y + 0.016, 0.1}));
  const dvec3 lens(0.06, y + 0.05 + kLensRadius, 0.18);
  builder.place("free-form lens", makeLens(),
                makeGlass(builder, "flint glass", 1.62f, vec3(0.93f, 0.96f, 0.99f), 0.1f), moveBy(lens));
  builder.place("foot of the lens", geometry::makeCone(0.08, 0.012, 0.048, 48, true), brass,
                moveBy({lens.x, y, lens.z}));
  builder.place("glass block", geometry::makeBox({0.2, 0.2, 0.2}),
                makeGlass(builder, "green glass", 1.5f, vec3(0.45f, 0.85f, 0.6f), 0.2f),
                standAt({0.47, y + 0.101, 0.12}, 28));
}

void addThings(SceneBuilder& builder) {
  const double y = kDesk + 0.0035;
  builder.place("desk", makeTable(builder, {1.7, kDesk, 0.95}, furnitureWood(builder)),
                standAt({0, 0.002, 0}));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("red block", makeToyBlock(builder, 0.13, "ABC", pine, colour(0xB8322A)),
                standAt({-0.52, y, -0.26}, 24));
  builder.place("blue block", makeToyBlock(builder, 0.12, "123", pine, colour(0x2B4FA0)),
                standAt({-0.2, y, -0.24}, -18));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0x2F6F9F), 0.25f)),
                standAt({0.3, y, -0.3}, -30, 0.19));
  builder.place("globe", makeGlobe(builder), standAt({0.03, y, -0.2}, 40));
  builder.place("cone", geometry::makeCone(0.06, 0, 0.2, 32, true),
                builder.paint("orange paint", colour(0xE8761C), 0.4f), standAt({0.62, y, -0.2}));
  builder.place("desk lamp", makeDeskLamp(builder), standAt({-0.72, y, -0.3}));
  const int chair = builder.addMesh("chair", makeChair(builder));
  builder.place("chair", chair, standAt({1.35, 0.002, -0.9}, -120));
  builder.place("bookshelf", makeBookshelf(builder, {1.2, 1.8, 0.3}, 5), standAt({-0.7, 0.002, -2.1}));
  builder.place("plant", makePottedPlant(builder, 1.5, 3), standAt({1.8, 0.002, -1.6}));
}

}  // namespace

Scene makeLenses() {
  SceneBuilder builder("lenses");
  builder.addCamera("front", {0.06, 1.22, 1.35}, {0.03, kDesk + 0.17, 0.0}, 40);
  builder.addCamera("near", {-0.5, 1.05, 0.75}, {-0.25, kDesk + 0.17, 0.0}, 45);
  BakedLight light;
  light.addBox({0, kDesk - 0.03, 0}, {1.7, 0.05, 0.95});
  light.addBox({1.35, 0.3, -0.9}, {0.45, 0.5, 0.45}, 0.7);
  light.addColumn({1.8, 0, -1.6}, 0.3, 0.3, 0.4);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xC7BFA8), colour(0xC79D6A), colour(0x93673C)});
  addGlass(builder);
  addThings(builder);
  builder.addLamp({0.8, 2.3, 0.6}, vec3(2.0f, 1.9f, 1.75f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
