// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/nearest_hit.h"

#include <gtest/gtest.h>

#include <random>

#include "catoptric/geometry/shapes.h"

namespace catoptric::geometry {
namespace {

std::vector<vec3> cornersOf(const Mesh& mesh) {
  std::vector<vec3> corners;
  for (const std::uint32_t i : mesh.indices) corners.push_back(mesh.positions[i]);
  return corners;
}

TriangleHierarchy makeHierarchy(const std::vector<vec3>& corners, std::uint32_t flags) {
  std::vector<HierarchyTriangle> triangles;
  for (std::uint32_t t = 0; 3 * t < corners.size(); ++t)
    triangles.push_back({corners[3 * t], corners[3 * t + 1], corners[3 * t + 2], t, 0, flags});
  return TriangleHierarchy(triangles);
}

TEST(NearestHit, nothingIsHitWhereNothingIs) {
  EXPECT_FALSE(findNearestHit(makeHierarchy({}, kTwoSided), {0, 0, 0}, {0, 0, 1}));
  const TriangleHierarchy one = makeHierarchy({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, kTwoSided);
  EXPECT_FALSE(findNearestHit(one, {2, 2, 1}, {0, 0, -1}));
  EXPECT_FALSE(findNearestHit(one, {0.2, 0.2, 1}, {0, 0, 1}));
}

TEST(NearestHit, backsCountOnlyWhereBothSidesDo) {
  const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const dvec3 below(0.2, 0.3, -1), above(0.2, 0.3, 2);
  EXPECT_FALSE(findNearestHit(makeHierarchy(corners, 0), below, {0, 0, 1}));
  const auto back = findNearestHit(makeHierarchy(corners, kTwoSided), below, {0, 0, 1});
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->isFront);
  const auto front = findNearestHit(makeHierarchy(corners, 0), above, {0, 0, -1});
  ASSERT_TRUE(front);
  EXPECT_TRUE(front->isFront);
  EXPECT_DOUBLE_EQ(front->distance, 2);
  EXPECT_DOUBLE_EQ(front->u, 0.2);
  EXPECT_NEAR(front->v, 0.3, 1e-12);
  EXPECT_FALSE(findNearestHit(makeHierarchy(corners, 0), above, {0, 0, -1}, 0, 0));  // ignored
  EXPECT_FALSE(findNearestHit(makeHierarchy(corners, 0), above, {0, 0, -1}, 2.1));
}

TEST(NearestHit, findsWhatLookingAtEveryTriangleFinds) {
  std::vector<vec3> corners = cornersOf(makeIcosphere(0.7, 6));
  for (const vec3& c : cornersOf(makeTorus(1.2, 0.2, 24, 12))) corners.push_back(c);
  const TriangleHierarchy all = makeHierarchy(corners, kTwoSided);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const dvec3 origin = 2.0 * dvec3(uniform(random), uniform(random), uniform(random));
    dvec3 direction = dvec3(uniform(random), 0.3 * uniform(random), uniform(random)) - origin;
    if (i % 10 == 0) direction[i / 10 % 3] = 0;  // along a plane of the boxes
    std::optional<double> nearest;
    for (std::size_t t = 0; 3 * t < corners.size(); ++t) {
      const TriangleHierarchy one =
          makeHierarchy({corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]}, kTwoSided);
      const auto hit = findNearestHit(one, origin, direction);
      if (hit && (!nearest || hit->distance < *nearest)) nearest = hit->distance;
    }
    const auto found = findNearestHit(all, origin, direction);
    ASSERT_EQ(found.has_value(), nearest.has_value());
    if (found) {
      EXPECT_EQ(found->distance, *nearest);
    }
    hits += found ? 1 : 0;
  }
  EXPECT_GT(hits, 50);
}

}  // namespace
}  // namespace catoptric::geometry
