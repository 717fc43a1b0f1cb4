// SPDX-License-Identifier: Apache-2.0
// What a driver sees: a flat inner mirror and two convex wing mirrors with an aspheric outer part, a road and
// its traffic. The own car drives along the middle of three lanes towards -z; the driver's eye is near the
// origin.
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/car_interior.h"
#include "catoptric/scene/built_in/noise.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/vehicles.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::Mesh;

constexpr double kRoadHalf = 6.0, kLane = 3.5, kRoadFrom = -150, kRoadTo = 150, kTile = 12, kStep = 6;

struct RoadUser {
  const char* name;
  const char* paint;
  std::uint32_t colourHex;
  bool isTruck;
  double x, z;
};

constexpr RoadUser kTraffic[] = {{"blue car behind left", "blue car paint", 0x1F4E9C, false, -kLane, 8.5},
                                 {"yellow car behind", "yellow car paint", 0xD9A520, false, 0.15, 15},
                                 {"red car behind right", "red car paint", 0xA8201C, false, kLane, 10.5},
                                 {"truck behind right", "green truck paint", 0x2E6B4A, true, kLane + 0.1, 27},
                                 {"white car behind left", "white car paint", 0xDAD9D3, false, -kLane, 32},
                                 {"red car ahead", "red car paint", 0xA8201C, false, -0.1, -19},
                                 {"truck ahead right", "orange truck paint", 0xC8641E, true, kLane, -26},
                                 {"white car ahead left", "white car paint", 0xDAD9D3, false, -kLane, -34},
                                 {"blue car far ahead", "blue car paint", 0x1F4E9C, false, 0, -60}};

/// One tile, 12 m of road: u across, v along; edge lines, broken lane lines, worn asphalt.
Pattern roadTile() {
  const Pattern asphalt = repeated(speckle(colour(0x5A5A5B), colour(0x797876), 128, 3), {4, 4});
  return [=](dvec2 uv) {
    const double x = (uv.x - 0.5) * 2 * kRoadHalf, along = uv.y * kTile;
    const double worn = fractalNoise(uv * 64.0, ivec2(64), 3, 15);
    const double fromEdge = std::abs(std::abs(x) - 5.35), fromLane = std::abs(std::abs(x) - 0.5 * kLane);
    const bool isLine = fromEdge < 0.09 || (fromLane < 0.075 && along > 3.5 && along < 8.5);
    const double track =
        std::abs(std::fmod(std::abs(x) + 0.5 * kLane, kLane) - 0.5 * kLane);  // from the lane's middle
    const double tread = 0.1 * std::exp(-(track - 0.8) * (track - 0.8) / 0.05);
    const vec3 base = asphalt(uv) * float(1 - tread);
    return isLine && worn > 0.34 ? glm::mix(base, colour(0xE9E6DA), 0.9f) : base;
  };
}

/// A level strip between x0 and x1 along the whole road, cut every `step` metres, texture in repeats of
/// `repeat`.
Mesh makeStrip(double x0, double x1, double step, const dvec2& repeat) {
  const int cells = int((kRoadTo - kRoadFrom) / step);
  Mesh mesh = geometry::makePlane(x1 - x0, kRoadTo - kRoadFrom, 1, cells);
  mesh.uv1 = mesh.uv;
  mesh = withScaledUv(std::move(mesh), vec2((x1 - x0) / repeat.x, (kRoadTo - kRoadFrom) / repeat.y));
  return transformed(std::move(mesh), geometry::moveBy({0.5 * (x0 + x1), 0, 0.5 * (kRoadFrom + kRoadTo)}));
}

/// A strip of meadow that falls away under the road from its edge, so that no crack between the two shows the
/// sky.
Mesh makeApron(double x0, double x1) {
  Mesh mesh = makeStrip(x0, x1, kStep, {9, 9});
  for (vec3& p : mesh.positions) p.y = -0.4f * (float(kRoadHalf) - std::abs(p.x));
  return mesh;
}

void addGround(SceneBuilder& builder) {
  const int road = builder.textured("road", {1024, 1024}, roadTile(), 0.85f, 1);
  BakedLight light;
  for (const RoadUser& user : kTraffic)
    light.addBox({user.x, user.isTruck ? 1.8 : 0.65, user.z},
                 user.isTruck ? dvec3(2.4, 3.0, 8) : dvec3(1.66, 0.9, 4.2));
  light.addBox({0, 0.65, 0.7}, {1.66, 0.9, 4.2});
  const auto shade = light.bake({-kRoadHalf, kRoadFrom}, {kRoadHalf, kRoadTo}, 0, 64, 1024, 0.9, 0);
  builder.setOcclusion(road, "road shade", paintOcclusion(64, 1024, shade), 1);
  builder.placeShell("road", makeStrip(-kRoadHalf, kRoadHalf, kStep, {2 * kRoadHalf, kTile}), road);
  const int meadow = builder.textured("grass", {512, 512}, grass(5), 0.95f, 1);
  Mesh sides = makeStrip(-130, -kRoadHalf, kStep, {9, 9});
  append(sides, makeStrip(kRoadHalf, 130, kStep, {9, 9}));
  append(sides, makeApron(kRoadHalf - 0.6, kRoadHalf));
  append(sides, makeApron(-kRoadHalf, -kRoadHalf + 0.6));
  builder.placeShell("meadow", sides, meadow);
}

void addTraffic(SceneBuilder& builder) {
  std::map<std::string, int> meshes;
  for (const RoadUser& user : kTraffic) {
    const auto [entry, isNew] = meshes.try_emplace(user.paint, -1);
    if (isNew) {
      const vec3 paint = colour(user.colourHex);
      entry->second = builder.addMesh(user.paint, user.isTruck ? makeTruck(builder, user.paint, paint)
                                                               : makeCar(builder, user.paint, paint));
    }
    builder.place(user.name, entry->second, standAt({user.x, 0.003, user.z}));
  }
}

/// Guard rail on the left, wooden fence on the right.
void addRailAndFence(SceneBuilder& builder) {
  const int zinc = builder.metal("zinc", colour(0xA9AFB3), 0.45f),
            wood = builder.paint("fence wood", colour(0x8A6B4A), 0.9f);
  Mesh rail = geometry::transformed(geometry::makeBox({0.06, 0.28, 240}), geometry::moveBy({-6.7, 0.62, 0}));
  for (int i = -30; i <= 30; ++i)
    append(rail, geometry::transformed(geometry::makeBox({0.1, 0.7, 0.08}),
                                       geometry::moveBy({-6.79, 0.351, i * 4.0})));
  builder.place("guard rail", rail, zinc);
  Mesh fence;
  for (int i = -40; i <= 40; ++i)
    append(fence, geometry::transformed(geometry::makeBox({0.09, 1.1, 0.09}),
                                        geometry::moveBy({8.5, 0.551, i * 2.5})));
  for (double y : {0.45, 0.85})
    append(fence,
           geometry::transformed(geometry::makeBox({0.04, 0.12, 200}), geometry::moveBy({8.43, y, 0})));
  builder.place("fence", fence, wood);
}

void addRoadside(SceneBuilder& builder) {
  const int trees[] = {builder.addMesh("tree 1", makeTree(builder, 6.5, 2, 3)),
                       builder.addMesh("tree 2", makeTree(builder, 8.5, 7, 3))};
  int count = 0;
  const auto plant = [&](double x, double z) {
    const double size = 0.8 + 0.5 * hashToUnit(count, 1, 40);
    builder.place("tree " + std::to_string(count + 1), trees[count % 2],
                  standAt({x + 3 * hashToUnit(count, 2, 40), -0.05, z + 4 * hashToUnit(count, 3, 40)},
                          50.0 * count, size));
    ++count;
  };
  for (double z = -110; z <= 110; z += 17) plant(-14, z);
  for (double z = -100; z <= 100; z += 26) plant(-24, z + 7);
  for (double z = -105; z <= 105; z += 30) plant(12, z);
  const int houses[] = {
      builder.addMesh("house 1", makeHouse(builder, {9, 5.4, 7}, "yellow facade", colour(0xDCC48A))),
      builder.addMesh("house 2", makeHouse(builder, {8, 5.2, 7}, "white facade", colour(0xDDD9CF))),
      builder.addMesh("house 3", makeHouse(builder, {10, 5.6, 8}, "red facade", colour(0xB4694F)))};
  const dvec2 places[] = {{21, 16}, {22, 38}, {21, -24}, {23, -48}, {21, 62}, {24, -80}};
  for (std::size_t i = 0; i < std::size(places); ++i)
    builder.place("house " + std::to_string(i + 1), houses[i % 3],
                  standAt({places[i].x, 0.0, places[i].y}, -90));
}

}  // namespace

Scene makeDriversView() {
  SceneBuilder builder("drivers-view");
  addGround(builder);
  addTraffic(builder);
  addRailAndFence(builder);
  addRoadside(builder);
  addOwnCar(builder);
  builder.addSun({-6, 8, 5}, vec3(1.05f, 1.0f, 0.9f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
