// SPDX-License-Identifier: Apache-2.0
// What fineness does (Ofek & Rappoport 1998, figures 13 and 14), side by side in one picture: four booths,
// each with a ball before which a chequered board lies. In one scene the balls are cut more and more finely,
// in the other the boards. Boards keep the cuts that they are made of where --max-error is large.
#include <array>

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/built_in/surroundings.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

constexpr double kBooth = 1.0, kHeight = 0.9, kRadius = 0.38;

struct Fineness {
  int slices, stacks;  ///< of the ball
  int cells;           ///< of the board, along an edge
};

/// 32, 128, 512 and 2048 triangles, as in figure 13.
constexpr std::array<Fineness, 4> kBalls{{{8, 3, 28}, {16, 5, 28}, {32, 9, 28}, {64, 17, 28}}};
/// Figure 14 has 512 triangles in the reflector and finds 7 x 7 cells to be enough.
constexpr std::array<Fineness, 4> kBoards{{{32, 9, 1}, {32, 9, 3}, {32, 9, 7}, {32, 9, 15}}};

geometry::Mesh makeBall(const Fineness& fineness) {
  geometry::Mesh ball = geometry::makeUvSphere(kRadius, fineness.slices, fineness.stacks);
  ball.uv.clear();
  return geometry::welded(ball, 1e-6, 1e-3);  // the seam
}

void addBooth(SceneBuilder& builder, const Fineness& fineness, int index) {
  const std::string number = std::to_string(index + 1);
  const double x = (index - 1.5) * kBooth;
  builder.place("ball " + number, makeBall(fineness), builder.mirror("chrome"),
                moveBy({x, kRadius + 0.03, 0}));
  const int board =
      builder.textured("board", {256, 256}, checker(colour(0xF0E6D0), colour(0xB03A2E), 8, 8, 0.0), 0.7f, 2);
  builder.place("board " + number, geometry::makePlane(0.72, 0.6, fineness.cells, fineness.cells), board,
                moveBy({x, 0.012, 0.78}));
  const int red = builder.paint("red paint", colour(0xC2302A), 0.4f);
  builder.place("pole " + number, geometry::makeCylinder(0.03, 0.55, 24), red,
                moveBy({x - 0.41, 0.29, 0.55}));
  builder.place("bead " + number, geometry::makeUvSphere(0.07, 32, 16),
                builder.paint("blue paint", colour(0x2B4FA0), 0.35f), moveBy({x + 0.4, 0.08, 0.5}));
}

void addWalls(SceneBuilder& builder) {
  const int floor =
      builder.textured("floor", {512, 512}, tiles(colour(0xA7A194), colour(0x6F6A60), 8, 3), 0.7f, 2);
  const int wall = builder.textured("plaster", {256, 256}, plaster(colour(0xB9C2BE), 0.12, 6), 0.85f, 2);
  builder.placeShell("floor", geometry::makePlane(4 * kBooth + 1.0, 4.2, 6, 6), floor, moveBy({0, 0, 0.9}));
  builder.placeShell("back wall", geometry::makeBoxMetric({4 * kBooth + 1.0, kHeight, 0.04}, 1.0), wall,
                     moveBy({0, 0.5 * kHeight, -0.62}));
  for (int i = 0; i <= 4; ++i)
    builder.placeShell("partition " + std::to_string(i + 1),
                       geometry::makeBoxMetric({0.04, kHeight, 0.72}, 1.0), wall,
                       moveBy({(i - 2) * kBooth, 0.5 * kHeight, -0.25}));
}

Scene makeSweep(const char* name, const std::array<Fineness, 4>& steps) {
  SceneBuilder builder(name);
  builder.addCamera("front", {0, 1.5, 4.3}, {0, 0.3, 0.2}, 41);
  builder.addCamera("coarsest", {-1.5 * kBooth, 1.0, 2.2}, {-1.5 * kBooth, 0.3, 0.2}, 32);
  builder.addCamera("finest", {1.5 * kBooth, 1.0, 2.2}, {1.5 * kBooth, 0.3, 0.2}, 32);
  addWalls(builder);
  for (int i = 0; i < 4; ++i) addBooth(builder, steps[std::size_t(i)], i);
  builder.addSun({-2.0, 9, 5}, vec3(0.85f, 0.8f, 0.72f));
  return builder.scene();
}

}  // namespace

Scene makeReflectorSweep() {
  return makeSweep("reflector-sweep", kBalls);
}

Scene makeObjectSweep() {
  return makeSweep("object-sweep", kBoards);
}

}  // namespace catoptric::scene::built_in
