// SPDX-License-Identifier: Apache-2.0
// A triangle that reaches through a focus has no image by its corners; its pixels are told by their rays.
#include "catoptric/virtual_object/mixed/incomplete_triangles.h"

#include <gtest/gtest.h>

#include <bit>

#include "catoptric/geometry/shapes.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

using raster::VertexKind;

/// Ten by ten pixels whose rays leave z = 0 along +z, a hundredth apart; one triangle across them at z = 2.
struct Setting {
  scene::WorldGeometry world;
  raster::TessellatedObjects objects;
  RayImages rays;
  std::array<IntervalVertices, kIntervals> vertices;
  std::array<std::vector<vec3>, kIntervals> screens;
  ReflectorMesh mesh = meshOf(geometry::makeIcosphere(1, 2));
  std::vector<uvec2> parts = std::vector<uvec2>(100, uvec2(1, 0));
  MirrorPixels pixels{{0, 0, 10, 10}, 2, parts, {std::vector<uvec2>(100), std::vector<float>(100), {}}};

  explicit Setting(bool isTurned = false) {
    world.positions = {{-1, -1, 2}, {1.05f, -1, 2}, {-1, 1.05f, 2}};
    world.indices = {0, 2, 1};  // front towards -z
    if (isTurned) world.indices = {0, 1, 2};
    world.parts.resize(1);
    objects.positions = world.positions;
    objects.indices = world.indices;
    objects.sourceTriangles = {0};
    objects.parts = {{.part = 0, .firstIndex = 0, .indexCount = 3}};
    rays.widthPx = rays.heightPx = 10;
    for (int i = 0; i < 100; ++i) {
      const int column = i % 10, row = i / 10;
      rays.origins.emplace_back(0.01f * float(column), 0.01f * float(row), 0, 3);
      rays.directions.emplace_back(0, 0, 1, 1e-6f);
      rays.words.emplace_back(0, i % 10 == 0 ? 1 : 2);
    }
    vertices[0].positions = {{0, 0, -2}, {0, 0, -2}, {0, 0, -2}};
    vertices[0].reflectionPoints = std::vector<vec3>(3, vec3(0));
    vertices[0].triangles = {0, 0, 0};
    vertices[0].kinds = {VertexKind::Reflected, VertexKind::None, VertexKind::Reflected};
    screens[0] = {{1, 1, 1}, {1, 1, 1}, {8, 8, 1}};
  }
  void draw() {
    drawIncomplete(objects, world, rays,
                   {.isFound = {true, false, false},
                    .vertices = vertices,
                    .screens = screens,
                    .mesh = mesh,
                    .eye = dvec3(0, 0, 3),
                    .widthPx = 10,
                    .heightPx = 10,
                    .pixelsPerTangent = 5,
                    .bounds = {0, 0, 10, 10},
                    .part = 1},
                   pixels);
  }
  [[nodiscard]] std::size_t count(std::uint32_t hit) const {
    return std::size_t(std::count_if(pixels.confirmed.hits.begin(), pixels.confirmed.hits.end(),
                                     [&](const uvec2& h) { return h.x == hit; }));
  }
};

TEST(IncompleteTriangles, areSeenWhereTheirRaysMeetThem) {
  Setting setting;
  setting.parts[3 * 10 + 1].x = 2;                                                      // another part
  setting.pixels.confirmed.hits[0 * 10 + 2] = {7, std::bit_cast<std::uint32_t>(4.0f)};  // before it
  setting.pixels.confirmed.hits[0 * 10 + 3] = {7, std::bit_cast<std::uint32_t>(6.0f)};  // behind it
  setting.draw();
  for (int i = 0; i < 100; ++i) {
    const int x = i % 10, y = i / 10;
    if (x + y == 5) continue;  // its edge
    const bool isOther = x == 0 || (x == 1 && y == 3) || (x == 2 && y == 0);
    EXPECT_EQ(setting.pixels.confirmed.hits[std::size_t(i)].x == 1, x + y < 5 && !isOther) << x << ' ' << y;
  }
  EXPECT_EQ(std::bit_cast<float>(setting.pixels.confirmed.hits[11].y), 5.0f);  // 3 to the mirror, 2 beyond
  EXPECT_EQ(setting.count(7), 1u);
}

TEST(IncompleteTriangles, doNotCountFromBehindOrWithAllTheirCorners) {
  Setting turned(true);
  turned.draw();
  EXPECT_EQ(turned.count(1), 0u);
  turned.world.parts[0].isSeenFromBehind = true;
  turned.draw();
  EXPECT_GT(turned.count(1), 10u);
  Setting complete;
  complete.vertices[0].kinds[1] = VertexKind::Reflected;
  complete.draw();
  EXPECT_EQ(complete.count(1), 0u);
  complete.vertices[0].kinds.assign(3, VertexKind::None);
  complete.draw();
  EXPECT_EQ(complete.count(1), 0u);
}

}  // namespace
}  // namespace catoptric::virtual_object
