// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/simplified_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "catoptric/geometry/nearest_point.h"
#include "catoptric/geometry/shapes.h"

namespace catoptric::geometry {
namespace {

std::vector<SimplifiedLevel> simplify(const Mesh& mesh) {
  return makeSimplifiedLevels(
      {.positions = mesh.positions, .normals = mesh.normals, .indices = mesh.indices, .uv0 = mesh.uv});
}

TriangleHierarchy makeHierarchy(const Mesh& mesh, const std::vector<std::uint32_t>& indices) {
  std::vector<HierarchyTriangle> triangles;
  for (std::uint32_t t = 0; t < indices.size() / 3; ++t)
    triangles.push_back({mesh.positions[indices[3 * t]], mesh.positions[indices[3 * t + 1]],
                         mesh.positions[indices[3 * t + 2]], t, 0, 0});
  return TriangleHierarchy(triangles);
}

/// The largest distance from random points on one list of triangles to the other.
double sampleDistance(const Mesh& mesh, const std::vector<std::uint32_t>& from,
                      const std::vector<std::uint32_t>& to, int count) {
  const TriangleHierarchy hierarchy = makeHierarchy(mesh, to);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double largest = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t* v = &from[3 * (random() % (from.size() / 3))];
    double a = unit(random), b = unit(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const dvec3 p = (1 - a - b) * dvec3(mesh.positions[v[0]]) + a * dvec3(mesh.positions[v[1]]) +
                    b * dvec3(mesh.positions[v[2]]);
    largest = std::max(largest, findNearestPoint(hierarchy, p, 1e9, 0)->distance);
  }
  return largest;
}

TEST(NearestPoint, isThatOfAllTriangles) {
  const Mesh mesh = makeTorus(1, 0.3, 24, 12);
  const TriangleHierarchy hierarchy = makeHierarchy(mesh, mesh.indices);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-1.5, 1.5);
  for (int i = 0; i < 300; ++i) {
    const dvec3 p(within(random), within(random), within(random));
    double best = 1e9;
    for (const HierarchyTriangle& t : hierarchy.triangles()) {  // each alone
      const TriangleHierarchy alone(std::span(&t, 1));
      best = std::min(best, findNearestPoint(alone, p, 1e9, 0)->distance);
    }
    const auto found = findNearestPoint(hierarchy, p, 1e9, 0);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, best, 1e-12);
    EXPECT_FALSE(findNearestPoint(hierarchy, p, 0.999 * best, 0));
    EXPECT_FALSE(findNearestPoint(hierarchy, p, 1e9, 1)) << "another part";
  }
}

TEST(SimplifiedLevels, errorsHoldBetweenTheSamplesToo) {
  Mesh ring = makeTorus(1, 0.3, 96, 48);
  ring.uv.clear();
  for (const Mesh& mesh : {makeIcosphere(0.3, 16), ring}) {
    const auto levels = simplify(mesh);
    ASSERT_GE(levels.size(), 2u);
    double last = 0;
    for (const SimplifiedLevel& level : levels) {
      EXPECT_GE(level.distance, last);
      last = level.distance;
      // Measured at vertices and middles of edges; in between it may be a little more.
      EXPECT_LE(sampleDistance(mesh, mesh.indices, level.indices, 4000), 1.1 * level.distance + 1e-7);
      EXPECT_LE(sampleDistance(mesh, level.indices, mesh.indices, 4000), 1.1 * level.distance + 1e-7);
      EXPECT_GT(level.distance, 0);
    }
  }
}

TEST(SimplifiedLevels, getShorterByHalfAtLeastOrEnd) {
  const Mesh mesh = makeIcosphere(1, 20);
  std::size_t last = mesh.indices.size();
  for (const SimplifiedLevel& level : simplify(mesh)) {
    EXPECT_LT(level.indices.size(), 7 * last / 10);
    last = level.indices.size();
    for (const std::uint32_t v : level.indices) ASSERT_LT(v, mesh.positions.size());
  }
  EXPECT_LT(last, mesh.indices.size() / 9);
}

using Edge = std::array<std::uint32_t, 2>;

/// Edges of one triangle only: borders, and both sides of a seam.
std::set<Edge> findBorder(const std::vector<std::uint32_t>& indices) {
  std::set<Edge> edges;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
    if (edges.erase({b, a}) == 0) edges.insert({a, b});
  }
  return edges;
}

TEST(SimplifiedLevels, keepBordersAndSeams) {
  // An open cylinder side, whose texture has a seam from top to bottom; a curved sheet.
  Mesh sheet = makePlane(2, 2, 40, 40);
  for (vec3& p : sheet.positions) p.y = 0.1f * std::sin(2 * p.x) * std::cos(2 * p.z);
  for (const Mesh& mesh : {makeCylinderSide(0.5, 1, 48, 24, true), sheet}) {
    const auto levels = simplify(mesh);
    ASSERT_FALSE(levels.empty());
    for (const SimplifiedLevel& level : levels)
      EXPECT_EQ(findBorder(level.indices), findBorder(mesh.indices));
  }
}

TEST(SimplifiedLevels, aTextureThatSlipsIsAnError) {
  Mesh flat = makePlane(1, 1, 32, 32);
  const auto exact = simplify(flat);
  ASSERT_FALSE(exact.empty());
  EXPECT_LT(exact.back().distance, 1e-6);
  for (vec2& uv : flat.uv) uv.x += 0.02f * std::sin(20 * uv.y);  // flat as before, the texture is not
  const auto warped = simplify(flat);
  for (const SimplifiedLevel& level : warped) EXPECT_GT(level.distance, 1e-4);
}

TEST(SimplifiedLevels, aTurnOfNormalsIsSeen) {
  Mesh flat = makePlane(1, 1, 32, 32);
  flat.uv.clear();
  for (std::size_t v = 0; v < flat.normals.size(); ++v)
    flat.normals[v] = glm::normalize(vec3(0.1f * std::sin(25 * flat.positions[v].x), 1, 0));
  for (const SimplifiedLevel& level : simplify(flat)) EXPECT_GT(level.normalRadians, 0.01);
}

TEST(SimplifiedLevels, leaveAloneWhatCannotGetSmaller) {
  EXPECT_TRUE(simplify(makeBox({1, 1, 1})).empty());
  EXPECT_TRUE(simplify(Mesh{}).empty());
  Mesh faceted = makeIcosphere(1, 8);  // each triangle with corners of its own: all of it is border
  Mesh apart;
  for (std::size_t i = 0; i < faceted.indices.size(); ++i) {
    const std::size_t t = i - i % 3;
    const auto at = [&](std::size_t k) { return faceted.positions[faceted.indices[t + k]]; };
    apart.positions.push_back(faceted.positions[faceted.indices[i]]);
    apart.normals.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
    apart.indices.push_back(std::uint32_t(i));
  }
  EXPECT_TRUE(simplify(apart).empty());
}

}  // namespace
}  // namespace catoptric::geometry
