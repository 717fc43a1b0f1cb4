// SPDX-License-Identifier: Apache-2.0
// Where each pixel's own ray meets the triangle, edges across which a plane goes on are cut coarsely and
// outlines finely (raster/tessellation.cpp, step 2); and what lies across a corner of the mirror is drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "catoptric/geometry/shapes.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_triangles.h"
#include "reflection_harness.h"

namespace catoptric::virtual_object {

using namespace raster;

namespace {

/// A wing mirror that looks towards +z; before it a floor in 2 x 2 squares that share their vertices, and a
/// folded screen.
test::TestWorld makeWorld() {
  geometry::Mesh cap = geometry::makePlane(0.4, 0.3, 8, 8);
  for (std::size_t i = 0; i < cap.positions.size(); ++i) {
    vec3& p = cap.positions[i];
    p = vec3(p.x, -p.z, std::sqrt(1.44f - p.x * p.x - p.z * p.z) - 1.2f);
    cap.normals[i] = glm::normalize(p + vec3(0, 0, 1.2f));
  }
  test::TestWorld world(cap);
  world.add(geometry::transformed(geometry::makePlane(6, 6, 2, 2), geometry::moveBy({0, -1, 4})), true);
  geometry::Mesh screen;
  screen.positions = {{-1, -1, 6}, {-1, 1, 6}, {0, -1, 5}, {0, 1, 5}, {1, -1, 6}, {1, 1, 6}};
  screen.normals.assign(6, vec3(0, 0, -1));
  screen.indices = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};
  world.add(screen, true);
  return world;
}

using Point = std::tuple<float, float, float>;
Point pointOf(const vec3& p) {
  return {p.x, p.y, p.z};
}

/// Lengths of the longest edges of a part: of those on a line of points, and of the others.
struct Longest {
  double onLine = 0, elsewhere = 0;
};
template <class IsOnLine>
Longest findLongest(const TessellatedObjects& objects, std::uint32_t part, const IsOnLine& isOnLine) {
  Longest longest;
  for (const TessellatedPart& run : objects.parts) {
    if (run.part != part) continue;
    for (std::uint32_t i = run.firstIndex; i < run.firstIndex + run.indexCount; ++i) {
      const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
      const vec3 a = objects.positions[objects.indices[i]], b = objects.positions[objects.indices[next]];
      double& length = isOnLine(a) && isOnLine(b) ? longest.onLine : longest.elsewhere;
      length = std::max(length, double(glm::length(b - a)));
    }
  }
  return longest;
}

TEST(Outlines, AreCutFinelyAndPlanesCoarsely) {
  const test::TestWorld world = makeWorld();
  const scene::WorldGeometry& g = world.geometry();
  const std::vector<std::uint8_t> all(g.parts.size(), 1);
  const TessellatedObjects byRays =
                               tessellateForReflector(g, 0, {.shadedByRays = all, .coarseInPlanes = true}),
                           plain = tessellateForReflector(g, 0);
  EXPECT_LT(byRays.indices.size(), plain.indices.size());
  const auto isOnFarSide = [](const vec3& p) { return p.z == 7; };
  const Longest floor = findLongest(byRays, 1, isOnFarSide), floorBefore = findLongest(plain, 1, isOnFarSide);
  EXPECT_LT(floor.onLine, 0.75 * floorBefore.onLine);
  EXPECT_GT(floor.elsewhere, 1.3 * floorBefore.elsewhere);
  // Planes do not go on across the fold; across the diagonals they do.
  const auto isOnFold = [](const vec3& p) { return p.x == 0; };
  const Longest screen = findLongest(byRays, 2, isOnFold), screenBefore = findLongest(plain, 2, isOnFold);
  EXPECT_LT(screen.onLine, 0.75 * screenBefore.onLine);
  EXPECT_GT(screen.elsewhere, 1.3 * screen.onLine);
}

TEST(Outlines, LeaveNoCracks) {
  const test::TestWorld world = makeWorld();
  const std::vector<std::uint8_t> all(world.geometry().parts.size(), 1);
  const TessellatedObjects objects =
      tessellateForReflector(world.geometry(), 0, {.shadedByRays = all, .coarseInPlanes = true});
  std::map<std::pair<Point, Point>, int> edges;
  double area = 0;
  for (std::uint32_t i = 0; i < objects.indices.size(); i += 3) {
    std::array<vec3, 3> p;
    for (std::uint32_t k = 0; k < 3; ++k) p[k] = objects.positions[objects.indices[i + k]];
    area += 0.5 * double(glm::length(glm::cross(p[1] - p[0], p[2] - p[0])));
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = pointOf(p[k]), b = pointOf(p[(k + 1) % 3]);
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
    }
  }
  EXPECT_NEAR(area, 36 + 4 * std::sqrt(2.0), 1e-3);
  for (const auto& [edge, balance] : edges) {  // what has no other side lies on the boundary
    if (balance == 0) continue;
    const auto& [x, y, z] = edge.first;
    EXPECT_TRUE(std::abs(x) == 3 || z == 1 || z == 7 || std::abs(x) == 1 || std::abs(y) == 1)
        << x << " " << y << " " << z;
  }
}

TEST(Selection, keepsWhatLiesAcrossACornerOfTheMirror) {
  const test::TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  const std::size_t n = objects.positions.size();
  std::vector<vec3> mirrored(n);
  for (std::size_t i = 0; i < n; ++i) mirrored[i] = objects.positions[i] * vec3(1, 1, -1);
  const std::vector<vec3> points(n, vec3(0));
  VirtualTriangles out;
  const auto countKept = [&](VertexKind kind) {
    const std::vector<VertexKind> kinds(n, kind);
    selectVirtualTriangles(objects, {0, 0.5, 3}, mirrored, kinds, points, out);
    return out.indices.size() / 3;
  };
  EXPECT_GT(countKept(VertexKind::Reflected), 0u);
  EXPECT_EQ(countKept(VertexKind::PastBoundary), countKept(VertexKind::Reflected));
  EXPECT_EQ(countKept(VertexKind::DoublyVirtual), 0u);
}

TEST(Selection, keepsWhatIsHiddenInPartUnlessTheMirrorBendsAwayFromIt) {
  const test::TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  const std::size_t n = objects.positions.size();
  std::vector<vec3> mirrored(n), points(n, vec3(0));
  for (std::size_t i = 0; i < n; ++i) mirrored[i] = objects.positions[i] * vec3(1, 1, -1);
  VirtualTriangles all, some;
  const dvec3 eye(0, 0.5, 3);
  const std::vector<VertexKind> reflected(n, VertexKind::Reflected);
  markVirtualTriangles(objects, eye, mirrored, reflected, points, all);
  std::vector<VertexKind> kinds(n, VertexKind::PastBoundary);
  for (std::size_t i = 0; i < n; ++i)
    if (objects.positions[i].x > 0) kinds[i] = VertexKind::DoublyVirtual, points[i] = vec3(0.2f, 0, 0);
  const auto expectKept = [&](float longest) {
    markVirtualTriangles(objects, eye, mirrored, kinds, points, some, {}, {.atBoundary = longest});
    std::size_t across = 0;
    for (std::size_t t = 0; t < all.isKept.size(); ++t) {
      int hidden = 0;
      for (std::size_t k = 0; k < 3; ++k)
        hidden += kinds[objects.indices[3 * t + k]] == VertexKind::DoublyVirtual ? 1 : 0;
      const bool isAcross = hidden == 1 || hidden == 2;
      across += isAcross ? 1 : 0;
      const bool isWanted = hidden == 0 || (isAcross && longest > 0.2f);
      EXPECT_EQ(some.isKept[t] != 0, all.isKept[t] != 0 && isWanted) << t;
    }
    EXPECT_GT(across, 0u);
  };
  expectKept(0.3f);
  expectKept(0.1f);
}

}  // namespace
}  // namespace catoptric::virtual_object
