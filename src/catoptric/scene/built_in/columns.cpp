// SPDX-License-Identifier: Apache-2.0
// Columns around a chrome sphere, and a cube close to it (Martin & Popescu 2004, figure 1). The camera stands
// outside the ring of columns and looks between two of them.
#include <cmath>

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kHallSize(8, 3.4, 8);
constexpr int kColumnCount = 8;
constexpr double kRingRadius = 1.35, kColumnHeight = 1.9;

dvec3 columnPlace(int i) {
  const double angle = (i + 0.5) * 2 * glm::pi<double>() / kColumnCount;
  return {kRingRadius * std::sin(angle), 0, kRingRadius * std::cos(angle)};
}

void addHall(SceneBuilder& builder) {
  BakedLight light;
  light.addBall({0, 0.5, 0}, 0.5);
  light.addBox({0.44, 0.13, 0.52}, dvec3(0.26), 0.5);
  for (int i = 0; i < kColumnCount; ++i) light.addColumn(columnPlace(i), 0.11, 0.11, kColumnHeight);
  light.setLamp({-1.5, 3.2, 2.2}, 0.6);
  const dvec2 half(0.5 * kHallSize.x, 0.5 * kHallSize.z);
  const auto baked = light.bake(-half, half, 0, 256, 256, 0.85, 0.4);
  RoomOptions hall;
  hall.size = kHallSize;
  const Pattern tiles = checker(colour(0xD8CDB8), colour(0x6E5A4B), 16, 16);
  hall.floor = builder.textured("hall floor", {1024, 1024}, shaded(tiles, baked), 0.5f, 1);
  hall.walls = builder.textured("hall plaster", {256, 256}, plaster(colour(0xC9BFA8), 0.06, 8), 0.9f, 1);
  hall.ceiling = builder.paint("ceiling", colour(0xE9E6DF), 0.95f);
  hall.openings[kFront] = {{{1.2, 0.6}, {6.8, 2.9}}};
  hall.openings[kLeft] = {{{2.0, 0.9}, {6.0, 2.7}}};
  addRoom(builder, hall);
}

std::vector<Piece> makeColumn(SceneBuilder& builder) {
  const int stone = builder.textured("column stone", {256, 256},
                                     stripes(colour(0xE6DCC6), colour(0xB89B72), 12, 1), 0.7f, 2);
  const int base = builder.paint("column base", colour(0x8C6F52), 0.7f);
  const double slab = 0.08;
  std::vector<Piece> pieces;
  pieces.push_back(
      {geometry::transformed(geometry::makeBox({0.28, slab, 0.28}), moveBy({0, 0.5 * slab, 0})), base});
  pieces.push_back(
      {geometry::transformed(geometry::makeCylinderSide(0.1, kColumnHeight - 2 * slab, 32, 8, true),
                             moveBy({0, 0.5 * kColumnHeight, 0})),
       stone});
  pieces.push_back({geometry::transformed(geometry::makeBox({0.28, slab, 0.28}),
                                          moveBy({0, kColumnHeight - 0.5 * slab, 0})),
                    base});
  return pieces;
}

}  // namespace

Scene makeColumns() {
  SceneBuilder builder("columns");
  builder.addCamera("inside", {0.06, 1.15, 2.3}, {0, 0.55, 0}, 36);
  addHall(builder);
  const double y = 0.001;
  builder.place("sphere", geometry::makeIcosphere(0.5, 24), builder.mirror("chrome", vec3(0.94f)),
                moveBy({0, 0.501, 0}));
  const auto column = makeColumn(builder);
  const int columnMesh = builder.addMesh("column", column);
  for (int i = 0; i < kColumnCount; ++i) {
    const dvec3 place = columnPlace(i);
    builder.place("column " + std::to_string(i + 1), columnMesh, moveBy({place.x, y, place.z}));
  }
  builder.place("cube", makeToyBlock(builder, 0.26, "ABC", colour(0xE8D3A6), colour(0xB8322A)),
                standAt({0.44, y, 0.52}, 28));
  builder.addLamp({-1.5, 2.9, 2.2}, vec3(2.4f, 2.3f, 2.1f));
  builder.addLamp({2.0, 2.6, -1.0}, vec3(1.2f, 1.2f, 1.3f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
