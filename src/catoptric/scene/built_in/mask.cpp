// SPDX-License-Identifier: Apache-2.0
// A mask of several convex and concave pieces (Ofek & Rappoport 1998, figure 19): a face as one smooth sheet,
// nose and cheeks convex, eye sockets and mouth concave, with a red and a green ball to either side.
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kRoomSize(4.8, 2.6, 4.6);
const dvec2 kHalf(0.42, 0.54);
const dvec3 kCentre(0, 1.32, -2.05);

/// A bump that adds amount * exp(-|(p - centre) / width|^2).
struct Bump {
  double amount;
  dvec2 centre, width;
};

const Bump kBumps[] = {{0.045, {0, -0.02}, {0.13, 0.17}},    {-0.030, {-0.18, 0.17}, {0.11, 0.11}},
                       {-0.030, {0.18, 0.17}, {0.11, 0.11}}, {0.025, {-0.22, -0.13}, {0.12, 0.12}},
                       {0.025, {0.22, -0.13}, {0.12, 0.12}}, {-0.020, {0, -0.33}, {0.16, 0.09}},
                       {0.020, {0, 0.36}, {0.25, 0.12}},     {0.018, {0, -0.45}, {0.13, 0.10}}};

geometry::HeightSample faceAt(dvec2 p) {
  geometry::HeightSample at{-0.5 * p.x * p.x - 0.3 * p.y * p.y, -p.x, -0.6 * p.y};
  for (const Bump& bump : kBumps) {
    const dvec2 d = (p - bump.centre) / bump.width;
    const double value = bump.amount * std::exp(-glm::dot(d, d));
    at.z += value;
    at.dzdx -= 2 * value * d.x / bump.width.x;
    at.dzdy -= 2 * value * d.y / bump.width.y;
  }
  return at;
}

/// Bulging outline, narrower towards the chin.
dvec2 outlineFromSquare(dvec2 s) {
  const dvec2 p(s.x * std::sqrt(1 - 0.36 * s.y * s.y), s.y * std::sqrt(1 - 0.36 * s.x * s.x));
  return kHalf * p * dvec2(1 + 0.1 * p.y, 1);
}

void addMask(SceneBuilder& builder) {
  builder.place("mask", geometry::makeHeightField(120, 144, outlineFromSquare, faceAt),
                builder.mirror("gilt", vec3(0.97f, 0.92f, 0.82f)), moveBy(kCentre));
  // A dark board behind it, of the same outline, a little larger.
  const auto flat = [](dvec2) { return geometry::HeightSample{-0.19, 0, 0}; };
  const auto wider = [](dvec2 s) { return 1.12 * outlineFromSquare(s); };
  builder.place("board", geometry::makeHeightField(24, 24, wider, flat),
                builder.paint("dark wood", colour(0x3A2A20), 0.6f), moveBy(kCentre));
}

void addThings(SceneBuilder& builder) {
  const int red = builder.paint("red", colour(0xC42B22), 0.35f),
            green = builder.paint("green", colour(0x2C9A44), 0.35f);
  const int stand = builder.addMesh("stand", makeStripedPole(builder, 1.02, 0.02));
  for (const double side : {-1.0, 1.0}) {
    const dvec3 foot(0.6 * side, 0.002, -1.74);
    builder.place(side < 0 ? "left stand" : "right stand", stand, standAt(foot));
    builder.place(side < 0 ? "red ball" : "green ball", geometry::makeUvSphere(0.11, 40, 20),
                  side < 0 ? red : green, moveBy(foot + dvec3(0, 1.162, 0)));
  }
  builder.place("table", makeTable(builder, {1.1, 0.72, 0.5}, furnitureWood(builder)),
                standAt({0, 0.002, -1.4}));
  const double y = 0.7235;
  const vec3 pine = colour(0xE8D3A6);
  builder.place("block 1", makeToyBlock(builder, 0.14, "ABC", pine, colour(0xB8322A)),
                standAt({-0.3, y, -1.3}, 20));
  builder.place("block 2", makeToyBlock(builder, 0.11, "DEF", pine, colour(0x2B4FA0)),
                standAt({0.12, y, -1.25}, -25));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0xC77A2C), 0.25f)),
                standAt({0.36, y, -1.42}, 160, 0.17));
  builder.place("globe", makeGlobe(builder), standAt({-0.08, y, -1.45}, 40, 0.7));
  builder.place("sofa", makeSofa(builder, colour(0x2F4F6B)), standAt({0.6, 0.002, 1.85}, 180));
  builder.place("plant", makePottedPlant(builder, 1.6, 3), standAt({-1.5, 0.002, 0.8}));
  builder.place("bookshelf", makeBookshelf(builder, {1.2, 1.8, 0.3}, 5), standAt({2.38, 0.002, -0.9}, -90));
  builder.place("chair", makeChair(builder), standAt({1.3, 0.002, 0.2}, -150));
}

}  // namespace

Scene makeMask() {
  SceneBuilder builder("mask");
  builder.addCamera("front", {0.22, 1.55, 0.2}, {0.0, 1.22, -2.05}, 38);
  builder.addCamera("side", {-0.95, 1.45, -0.85}, {0.0, 1.3, -2.05}, 50);
  BakedLight light;
  light.addBox({0, 0.7, -1.4}, {1.1, 0.05, 0.5});
  light.addBox({0.6, 0.3, 1.85}, {1.6, 0.5, 0.8});
  light.addBox({2.22, 0.9, -0.9}, {0.3, 1.8, 1.2});
  light.addColumn({-1.5, 0, 0.8}, 0.3, 0.3, 0.4);
  light.addColumn({-0.6, 0, -1.74}, 0.07, 0.03, 0.2);
  light.addColumn({0.6, 0, -1.74}, 0.07, 0.03, 0.2);
  light.addBox({1.3, 0.3, 0.2}, {0.45, 0.5, 0.45}, 0.5);
  light.setLamp({0.8, 2.3, 0.6}, 0.4);
  addPictureRoom(builder, kRoomSize, light, {colour(0xC9B9A0), colour(0xB98A58), colour(0x7C4F2A)});
  addMask(builder);
  addThings(builder);
  builder.addLamp({-1.3, 2.3, 0.2}, vec3(1.6f, 1.5f, 1.35f));
  builder.addLamp({1.3, 2.3, -0.6}, vec3(1.2f, 1.15f, 1.05f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
