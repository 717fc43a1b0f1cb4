// SPDX-License-Identifier: Apache-2.0
// An open convex free-form patch without back faces, like the chrome fender of a car, with things close to it
// (the case of Blythe 1999: an open surface needs a rule for what lies behind its border). One bicubic Bezier
// patch, strictly convex: a horizontal curve moved along a vertical one, both of varying curvature.
#include <array>

#include "catoptric/geometry/bezier_patch.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/sweep.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/noise.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/vehicles.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

constexpr double kYard = 12;  // edge of the square ground
constexpr double kFenderHeight = 0.62;

void addFender(SceneBuilder& builder) {
  const geometry::BicubicPatch patch = geometry::makeTranslationalPatch(
      {dvec3(-0.95, 0, -0.40), dvec3(-0.55, 0, 0.0), dvec3(0.50, 0, 0.07), dvec3(0.95, 0, -0.30)},
      {dvec3(0, -0.34, -0.11), dvec3(0, -0.15, -0.01), dvec3(0, 0.14, 0.02), dvec3(0, 0.36, -0.13)});
  builder.place("fender", geometry::tessellatePatch(patch, 72, 40), builder.mirror("chrome"),
                moveBy({0, kFenderHeight, 0}));
}

BakedLight yardLight() {
  BakedLight light;
  light.addBox({0.05, kFenderHeight, -0.15}, {1.75, 0.55, 0.22});
  light.addBox({0, 0.75, -1.4}, {1.86, 0.8, 1.5});
  light.addColumn({-0.72, 0, 0.62}, 0.1, 0.01, 0.42);
  light.addColumn({0.2, 0, 0.95}, 0.09, 0.01, 0.36);
  light.addBox({0.74, 0.15, 0.6}, dvec3(0.3), 0.4);
  light.addBox({-0.25, 0.11, 0.8}, dvec3(0.22), -0.5);
  light.addColumn({1.15, 0, 0.2}, 0.1, 0.04, 0.3);
  light.addColumn({-1.2, 0, 0.15}, 0.1, 0.04, 0.3);
  light.addBox({-2.7, 0.5, 2.5}, {1.7, 0.9, 4.2}, 0.35);
  light.addBox({3.0, 0.5, 3.1}, {1.7, 0.9, 4.2}, -0.2);
  light.setLamp({-4, 9, 5}, 1.0);
  return light;
}

/// The front of the van that wears the fender; all of it behind the patch.
void addVan(SceneBuilder& builder) {
  const std::array<dvec2, 10> side = {
      dvec2(-1.5, 0.36), dvec2(0.0, 0.36),   dvec2(0.05, 0.42),  dvec2(0.05, 1.0),  dvec2(-0.02, 1.12),
      dvec2(-0.2, 1.2),  dvec2(-0.62, 1.28), dvec2(-0.95, 1.34), dvec2(-1.4, 1.36), dvec2(-1.5, 1.36)};
  constexpr double kFront = -0.66, kQuarterTurn = 1.5707963267948966;
  const int paint = builder.paint("van paint", colour(0x2F7C86), 0.3f),
            rubber = builder.paint("rubber", colour(0x1C1C1E), 0.85f);
  const int lamp = builder.glow("head light", vec3(1.0f, 0.97f, 0.88f)),
            rim = builder.metal("satin steel", colour(0x9BA0A5), 0.4f);
  const dmat4 worldFromSide = moveBy({0, 0, kFront}) * geometry::turnAround({0, 1, 0}, -kQuarterTurn);
  std::vector<Piece> pieces = {{transformed(geometry::makeExtrusion(side, 1.86, 0.7), worldFromSide), paint}};
  for (double x : {-0.72, 0.72}) {
    const dmat4 facing = moveBy({x, 1.06, kFront + 0.06}) * geometry::turnAround({1, 0, 0}, kQuarterTurn);
    pieces.push_back({transformed(geometry::makeDisc(0.085, 0, 32, true), facing), lamp});
    pieces.push_back({transformed(geometry::makeTorus(0.095, 0.016, 40, 12), facing), rim});
    const dmat4 axle = moveBy({1.2 * x, 0.3, kFront - 0.75}) * geometry::turnAround({0, 0, 1}, kQuarterTurn);
    pieces.push_back({transformed(geometry::makeCylinder(0.3, 0.2, 28), axle), rubber});
  }
  builder.place("van", pieces, moveBy({0, 0.002, 0}));
}

void addYard(SceneBuilder& builder) {
  const double h = 0.5 * kYard;
  const auto light = yardLight().bake(dvec2(-h), dvec2(h), 0, 288, 288, 0.8, 0.4);
  const Pattern asphalt = repeated(speckle(colour(0x605F5D), colour(0x858380), 96, 3), {7, 7});
  const Pattern ground = [=](dvec2 uv) {
    const dvec2 p = (uv - 0.5) * kYard;
    const double worn = fractalNoise(uv * 90.0, ivec2(90), 3, 15);
    const bool isBay =
        std::abs(std::fmod(std::abs(p.x + 1.3), 2.6) - 1.3) > 1.245 && std::abs(p.y - 0.6) < 2.6;
    const bool isEnd = std::abs(p.y - 3.25) < 0.06;
    const vec3 base = asphalt(uv);
    return (isBay || isEnd) && worn > 0.36 ? glm::mix(base, colour(0xE9E4D2), 0.85f) : base;
  };
  const int floor = builder.textured("yard", {1024, 1024}, shaded(ground, light), 0.85f, 1);
  builder.placeShell("ground", geometry::makePlane(kYard, kYard, 2, 2), floor);
  const int brick =
      builder.textured("brick", {512, 512}, bricks(colour(0x9C5A41), colour(0xB4AB9C), 4, 8, 12), 0.85f, 2);
  const dvec3 room(kYard, 2.6, kYard);
  const Opening gate{{4.5, 0.0}, {7.5, 2.2}};
  builder.placeShell("front wall", makeWall({kYard, 2.6}, {gate}, 1.2), brick, worldFromWall(room, kFront));
  builder.placeShell("left wall", makeWall({kYard, 1.2}, {}, 1.2), brick, worldFromWall(room, kLeft));
  builder.placeShell("right wall", makeWall({kYard, 1.2}, {}, 1.2), brick, worldFromWall(room, kRight));
  builder.placeShell("back wall", makeWall({kYard, 1.2}, {}, 1.2), brick, worldFromWall(room, kBack));
}

void addThings(SceneBuilder& builder) {
  const double y = 0.001;
  const int cone = builder.addMesh("traffic cone", makeTrafficCone(builder));
  builder.place("cone 1", cone, standAt({-0.72, y, 0.62}, 12, 0.6));
  builder.place("cone 2", cone, standAt({0.2, y, 0.95}, 40, 0.5));
  builder.place("cone 3", cone, standAt({1.9, y, 1.6}, 5));
  const vec3 pine = colour(0xE8D3A6);
  builder.place("crate 1", makeToyBlock(builder, 0.3, "ABC", pine, colour(0x2B4FA0)),
                standAt({0.74, y, 0.6}, 23));
  builder.place("crate 2", makeToyBlock(builder, 0.22, "123", pine, colour(0xB8322A)),
                standAt({-0.25, y, 0.8}, -29));
  const int pole = builder.addMesh("striped pole", makeStripedPole(builder, 1.2, 0.035));
  builder.place("pole 1", pole, standAt({1.15, y, 0.2}));
  builder.place("pole 2", pole, standAt({-1.2, y, 0.15}));
  builder.place(
      "ball", geometry::makeUvSphere(0.13, 32, 16),
      builder.textured("ball", {256, 128}, stripes(colour(0xF2C230), colour(0x2C6FB0), 1, 6), 0.35f, 2),
      standAt({0.48, y + 0.13, 1.15}, 30));
  builder.place("red car", makeCar(builder, "red car paint", colour(0xA8201C)), standAt({-2.7, y, 2.5}, 20));
  builder.place("white car", makeCar(builder, "white car paint", colour(0xDAD9D3)),
                standAt({3.0, y, 3.1}, -11));
  const int tree = builder.addMesh("tree", makeTree(builder, 4.6, 2));
  const dvec3 places[] = {{-5.2, 0, -8.6}, {4.2, 0, -9.2}, {-1.2, 0, -10}, {-5, 0, 9.5}, {5.5, 0, 9.2}};
  int count = 0;
  for (const dvec3& place : places) {
    builder.place("tree " + std::to_string(count + 1), tree,
                  standAt(place, 80.0 * count, 0.9 + 0.08 * count));
    ++count;
  }
}

}  // namespace

Scene makeFender() {
  SceneBuilder builder("fender");
  builder.addCamera("front", {0.35, 1.28, 2.0}, {0.0, 0.54, 0.1}, 44);
  builder.addCamera("low", {-0.9, 0.5, 1.9}, {0.0, 0.6, 0.0}, 42);
  addYard(builder);
  addFender(builder);
  addVan(builder);

  addThings(builder);
  builder.addSun({-4, 9, 5}, vec3(1.0f, 0.94f, 0.84f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
