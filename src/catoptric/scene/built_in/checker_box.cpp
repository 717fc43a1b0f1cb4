// SPDX-License-Identifier: Apache-2.0
// A teapot on top of an inverted pyramid inside a box: five sides carry a checkerboard, a planar mirror
// partly covers the sixth (Bastos & Stuerzlinger 1998, figure 6).
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/props.h"
#include "catoptric/scene/built_in/room.h"
#include "catoptric/scene/built_in/scenes.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::moveBy;

const dvec3 kBoxSize(3.2, 2.4, 3.2);
constexpr double kPyramidHeight = 0.85;

int checkerMaterial(SceneBuilder& builder, const std::string& name, std::uint32_t first, std::uint32_t second,
                    int columns, int rows) {
  const auto corners = edgeShade({kBoxSize.x, rows * 0.4}, 0.25, 0.35);
  return builder.textured(name, {1024, 512},
                          shaded(checker(colour(first), colour(second), columns, rows), corners), 0.7f, 1);
}

void addBox(SceneBuilder& builder) {
  BakedLight light;
  light.addColumn({0, 0, 0}, 0.02, 0.5, kPyramidHeight);
  light.setLamp({0.9, 4.5, 0.6}, 0.5);
  const dvec2 half(0.5 * kBoxSize.x, 0.5 * kBoxSize.z);
  const auto baked = light.bake(-half, half, 0, 192, 192, 0.8, 0.45);
  const auto corners = edgeShade({kBoxSize.x, kBoxSize.z}, 0.25, 0.35);
  const int floor = builder.textured("floor", {1024, 1024},
                                     shaded(checker(colour(0xE9E4D6), colour(0x3B4A57), 8, 8),
                                            [=](dvec2 uv) { return baked(uv) * corners(uv); }),
                                     0.6f, 1);
  builder.placeShell("floor", geometry::makePlane(kBoxSize.x, kBoxSize.z, 1, 1), floor);
  builder.placeShell("ceiling", geometry::flipped(geometry::makePlane(kBoxSize.x, kBoxSize.z, 1, 1)),
                     checkerMaterial(builder, "ceiling checks", 0xE8E3DA, 0xB9B3A8, 8, 8),
                     moveBy({0, kBoxSize.y, 0}));
  const struct {
    const char* name;
    Wall wall;
    std::uint32_t first, second;
  } walls[] = {{"left wall", kLeft, 0xE7D9C2, 0xA63A2E},
               {"right wall", kRight, 0xDDE3D4, 0x3A7A4C},
               {"front wall", kFront, 0xE9DFB8, 0xC28A2B}};
  for (const auto& w : walls) {
    // As makeWall() does, a little more than the wall, so that no crack shows the sky.
    constexpr double kOver = 0.02;
    const dvec2 size(kBoxSize.x, kBoxSize.y);
    geometry::Mesh quad =
        geometry::makeQuad({-kOver, -kOver, 0}, {size.x + kOver, -kOver, 0},
                           {size.x + kOver, size.y + kOver, 0}, {-kOver, size.y + kOver, 0});
    for (std::size_t i = 0; i < 4; ++i)
      quad.uv[i] = vec2(quad.positions[i].x / float(size.x), 1 - quad.positions[i].y / float(size.y));
    builder.placeShell(w.name, quad,
                       checkerMaterial(builder, std::string(w.name) + " checks", w.first, w.second, 8, 6),
                       worldFromWall(kBoxSize, w.wall));
  }
}

/// The sixth side: a plain wall, and on it the framed mirror, thin and a little off the wall.
void addMirrorWall(SceneBuilder& builder) {
  const int plainWall =
      builder.textured("mirror wall", {256, 256}, plaster(colour(0x8FA6BC), 0.06, 4), 0.9f, 1);
  builder.placeShell("back wall", makeWall({kBoxSize.x, kBoxSize.y}, {}, 2.0), plainWall,
                     worldFromWall(kBoxSize, kBack));
  const dvec2 h(1.32, 0.95);
  const double z = -0.5 * kBoxSize.z;
  builder.place("mirror", geometry::makeQuad({-h.x, -h.y, 0}, {h.x, -h.y, 0}, {h.x, h.y, 0}, {-h.x, h.y, 0}),
                builder.mirror("mirror glass", vec3(0.93f, 0.95f, 0.94f)), moveBy({0, 1.2, z + 0.012}));
  builder.place("mirror frame", makeFrame(2.0 * h, 0.06, 0.04),
                builder.paint("frame", colour(0x4A3524), 0.4f), moveBy({0, 1.2, z + 0.002}));
}

void addTeapotOnPyramid(SceneBuilder& builder) {
  // Four-sided cone turned upside down: apex on the floor, square top.
  const double half = 0.42;
  geometry::Mesh pyramid;
  const dvec3 apex(0, 0.002, 0);
  const dvec3 top[4] = {{-half, kPyramidHeight, half},
                        {half, kPyramidHeight, half},
                        {half, kPyramidHeight, -half},
                        {-half, kPyramidHeight, -half}};
  for (int i = 0; i < 4; ++i) {
    const dvec3 a = top[i], b = top[(i + 1) % 4];
    const vec3 n(glm::normalize(glm::cross(b - apex, a - apex)));
    geometry::Mesh side;
    side.positions = {vec3(apex), vec3(b), vec3(a)};
    side.normals = {n, n, n};
    side.uv = {{0.5f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
    side.indices = {0, 1, 2};
    geometry::append(pyramid, side);
  }
  geometry::append(pyramid, geometry::makeQuad(top[0], top[1], top[2], top[3]));
  const int stripesPaint =
      builder.textured("pyramid bands", {128, 256}, stripes(colour(0x2E5FA3), colour(0xE7E2D2), 4, 0), 0.5f);
  builder.place("inverted pyramid", pyramid, stripesPaint, geometry::turnAround({0, 1, 0}, 0.35));
  builder.place("teapot", makeTeapotPieces(builder.paint("teapot glaze", colour(0xC77A2C), 0.2f), 8),
                standAt({0, kPyramidHeight + 0.001, 0}, -25, 0.42));
}

}  // namespace

Scene makeCheckerBox() {
  SceneBuilder builder("checker-box");
  builder.addCamera("inside", {0.85, 1.62, 1.5}, {-0.14, 1.06, -0.55}, 56);
  const SceneBuilder::Station walk[] = {
      {{1.3, 1.5, 1.2}, {0, 1.1, -1.5}},      {{0.85, 1.62, 1.5}, {-0.14, 1.06, -0.8}},
      {{0.0, 1.7, 1.45}, {-0.1, 1.05, -0.8}}, {{-0.8, 1.45, 1.2}, {0.1, 1.1, -0.9}},
      {{-1.2, 1.3, 0.5}, {0.2, 1.15, -1.5}},  {{-1.0, 1.5, -0.4}, {0.3, 1.2, -1.6}}};
  builder.addWalk("walk", walk, 6.0, 56);
  addBox(builder);
  addMirrorWall(builder);
  addTeapotOnPyramid(builder);
  builder.addLamp({0.9, 2.2, 0.6}, vec3(1.5f, 1.45f, 1.35f));
  builder.addLamp({-0.9, 2.2, -0.5}, vec3(0.7f, 0.7f, 0.75f));
  return builder.scene();
}

}  // namespace catoptric::scene::built_in
