// SPDX-License-Identifier: Apache-2.0
// Solver `exact`, the part on the CPU: a triangle that a pixel's ray meets was offered to that pixel. By
// brute force, for rays that diverge, converge and cross. The twins cover wrong rays, and must miss some.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "catoptric/virtual_object/exact/ray_shaft.h"
#include "exact_rays.h"

namespace catoptric::virtual_object {
namespace {

/// Pixels whose nearest triangle was not among those that were offered to them; `hits`: pixels that meet any.
int countMissed(const RayImages& rays, const TriangleHierarchy& hierarchy, const Cover& cover, int& hits) {
  const auto offered = findOffered(rays, cover.opaque);
  int missed = 0;
  hits = 0;
  for (std::size_t i = 0; i < rays.origins.size(); ++i) {
    if (rays.words[i].y != kWord) continue;
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
    for (const HierarchyTriangle& t : hierarchy.triangles()) {
      const double distance = meet(rays.origins[i], rays.directions[i], t);
      if (distance < nearest) {
        nearest = distance;
        triangle = t.triangle;
      }
    }
    if (!std::isfinite(nearest)) continue;
    ++hits;
    missed += offered[i].count(triangle) == 0 ? 1 : 0;
  }
  return missed;
}

class EveryMirror : public testing::TestWithParam<Mirror> {};

TEST_P(EveryMirror, OffersEachPixelTheTriangleThatItSees) {
  std::mt19937 random(5);
  for (const double size : {0.05, 0.4, 3.0}) {
    const TriangleHierarchy hierarchy(makeTriangles(400, size, random));
    TileCover tiles(hierarchy);
    const RayImages rays = makeRays(GetParam().bend, GetParam().twist);
    Cover cover;
    tiles.compute(rays, wholePicture(), cover);
    int hits = 0;
    EXPECT_EQ(countMissed(rays, hierarchy, cover, hits), 0) << "triangles of " << size;
    EXPECT_GT(hits, size > 0.1 ? 100 : 0);
  }
}

TEST_P(EveryMirror, MissesSomeWhenTheRaysAreNotThoseThatWereCovered) {
  std::mt19937 random(5);
  const TriangleHierarchy hierarchy(makeTriangles(400, 0.4, random));
  TileCover tiles(hierarchy);
  Cover cover;
  tiles.compute(makeRays(GetParam().bend, GetParam().twist, 0.2), wholePicture(), cover);
  int hits = 0;
  EXPECT_GT(countMissed(makeRays(GetParam().bend, GetParam().twist), hierarchy, cover, hits), 20);
}

INSTANTIATE_TEST_SUITE_P(Exact, EveryMirror, testing::ValuesIn(kMirrors),
                         [](const auto& mirror) { return mirror.param.name; });

TEST(RayShaftTest, BoundsTheHeightsAtWhichItsRaysMeetATriangle) {
  std::mt19937 random(11);
  const RayImages rays = makeRays(0.7, 0.2);
  std::vector<vec4> origins, directions;
  for (int y = 16; y < 32; ++y)
    for (int x = 20; x < 36; ++x) {
      origins.push_back(rays.origins[std::size_t(y) * kEdge + std::size_t(x)]);
      directions.push_back(rays.directions[std::size_t(y) * kEdge + std::size_t(x)]);
    }
  const auto shaft = RayShaft::find({origins, directions}, 30.0);
  ASSERT_TRUE(shaft);
  int all = 0, some = 0;
  for (const double size : {0.1, 1.0, 6.0, 40.0})
    for (const HierarchyTriangle& t : makeTriangles(2000, size, random)) {
      std::size_t met = 0;
      for (std::size_t i = 0; i < origins.size(); ++i)
        met += std::isfinite(meet(origins[i], directions[i], t)) ? 1 : 0;
      const auto hit = shaft->mayMeet(t.a, t.b, t.c, (t.flags & kCoverSingleSided) != 0);
      if (met > 0) {
        ASSERT_TRUE(hit);
        EXPECT_TRUE(shaft->mayMeet(glm::min(t.a, glm::min(t.b, t.c)), glm::max(t.a, glm::max(t.b, t.c))));
        EXPECT_LE(hit->nearest, hit->furthest);
        ++some;
      }
      if (hit && hit->coversAll) {
        EXPECT_EQ(met, origins.size());
        ++all;
      }
    }
  EXPECT_GT(some, 100);
  EXPECT_GT(all, 5);
}

TEST(RayShaftTest, RefusesRaysThatSpreadTooFarAndNoRays) {
  const std::vector<vec4> origins(2, vec4(0)), apart{vec4(1, 0, 0, 0), vec4(-1, 0, 0, 0)};
  EXPECT_FALSE(RayShaft::find({origins, apart}, 1.0));
  EXPECT_FALSE(RayShaft::find({}, 1.0));
  const std::vector<vec4> none{vec4(0)};
  EXPECT_FALSE(RayShaft::find({none, none}, 1.0));  // a pixel without a mirror
}

TEST(TriangleHierarchyTest, HoldsEveryFiniteTriangleOnceInsideItsBoxes) {
  std::mt19937 random(3);
  std::vector<HierarchyTriangle> triangles = makeTriangles(777, 0.3, random);
  triangles[5].b.y = std::numeric_limits<float>::quiet_NaN();
  for (std::uint32_t i = 100; i < 200; ++i) {  // a heap of equal ones cannot be split by place
    triangles[i] = triangles[100];
    triangles[i].triangle = i;
  }
  const TriangleHierarchy hierarchy(triangles);
  std::set<std::uint32_t> seen;
  for (const TriangleHierarchy::Node& node : hierarchy.nodes())
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const HierarchyTriangle& t = hierarchy.triangles()[i];
      EXPECT_TRUE(seen.insert(t.triangle).second);
      for (const vec3& p : {t.a, t.b, t.c})
        EXPECT_TRUE(glm::all(glm::lessThanEqual(node.lower, p)) &&
                    glm::all(glm::lessThanEqual(p, node.upper)));
    }
  EXPECT_EQ(seen.size(), 776u);
  EXPECT_TRUE(TriangleHierarchy({}).nodes().empty());
}

TEST(TileCoverTest, LeavesOutTheExcludedPartAndAnswersAnEmptyScene) {
  std::mt19937 random(5);
  const std::vector<HierarchyTriangle> triangles = makeTriangles(300, 0.5, random);
  const TriangleHierarchy hierarchy(triangles), nothing({});
  const RayImages rays = makeRays(-0.5, 0.0);
  CoverQuery query = wholePicture();
  query.excludedPart = 2;
  Cover cover;
  TileCover(hierarchy).compute(rays, query, cover);
  EXPECT_FALSE(cover.opaque.empty());
  for (const CoverRect& r : cover.opaque) EXPECT_NE(triangles[r.item].part, 2u);
  TileCover(nothing).compute(rays, query, cover);
  EXPECT_TRUE(cover.opaque.empty());
}

}  // namespace
}  // namespace catoptric::virtual_object
