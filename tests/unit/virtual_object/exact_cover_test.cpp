// SPDX-License-Identifier: Apache-2.0
// Solver `exact`, the part on the CPU: a triangle that a pixel's ray meets was offered to that pixel. By
// brute force, for rays that diverge, converge and cross. The twins cover wrong rays, and must miss some.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/virtual_object/exact/ray_shaft.h"
#include "catoptric/virtual_object/exact/tile_cover.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kEdge = 48;
constexpr std::uint32_t kWord = 7;

/// Distance along the ray, by the same signs as the shader but in double; infinity for a miss.
double meet(const vec4& origin, const vec4& direction, const HierarchyTriangle& t) {
  const dvec3 o(vec3{origin}), d(vec3{direction});
  const dvec3 a = dvec3(t.a) - o, b = dvec3(t.b) - o, c = dvec3(t.c) - o;
  const double x = glm::dot(d, glm::cross(b, c)), y = glm::dot(d, glm::cross(c, a)),
               z = glm::dot(d, glm::cross(a, b));
  const dvec3 n = glm::cross(b - a, c - a);
  const double across = glm::dot(d, n);
  const bool inside = (x <= 0 && y <= 0 && z <= 0) || (x >= 0 && y >= 0 && z >= 0);
  const bool turnedAway = across > 0 && (t.flags & kCoverSingleSided) != 0;
  const double distance = glm::dot(a, n) / across;
  return inside && across != 0 && !turnedAway && distance > 1e-5 ? distance
                                                                 : std::numeric_limits<double>::infinity();
}

/// Rays off a patch z = f(x, y) lit from above; `bend` > 0: concave, with a focus; < 0: convex; `twist`:
/// saddle.
RayImages makeRays(double bend, double twist, double shift = 0.0) {
  RayImages rays;
  rays.widthPx = rays.heightPx = kEdge;
  const dvec3 eye(0.3, 0.1, 3.0);
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) {
      const double u = 2.0 * (x + 0.5) / kEdge - 1.0, v = 2.0 * (y + 0.5) / kEdge - 1.0;
      const dvec3 p(u, v, 0.5 * bend * (u * u + v * v) + 0.5 * twist * (u * u - v * v));
      const dvec3 n = glm::normalize(dvec3(-(bend + twist) * u, -(bend - twist) * v, 1.0));
      const dvec3 d = glm::normalize(core::reflectDirection(glm::normalize(p - eye), n) + dvec3(shift, 0, 0));
      rays.origins.emplace_back(vec3(p), 1.0f);
      rays.directions.emplace_back(vec3(glm::normalize(d)), 0.0f);
      const bool isMirror = u * u + v * v < 0.95;  // a round edge: tiles that are half empty
      rays.words.emplace_back(0u, isMirror ? kWord : 0u);
    }
  return rays;
}

std::vector<HierarchyTriangle> makeTriangles(std::uint32_t count, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-4.0, 4.0), offset(-size, size);
  std::vector<HierarchyTriangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const dvec3 centre(place(random), place(random), 2.5 + 0.6 * place(random));
    const auto corner = [&] { return vec3(centre + dvec3(offset(random), offset(random), offset(random))); };
    triangles.push_back({corner(), corner(), corner(), i, i % 5, i % 3 == 0 ? kCoverSingleSided : 0u});
  }
  return triangles;
}

/// Pixels whose nearest triangle was not among those that were offered to them; `hits`: pixels that meet any.
int countMissed(const RayImages& rays, const TriangleHierarchy& hierarchy, const Cover& cover, int& hits) {
  std::vector<std::set<std::uint32_t>> offered(rays.origins.size());
  for (const CoverRect& r : cover.opaque)
    for (int y = r.y; y < r.y + r.height; ++y)
      for (int x = r.x; x < r.x + r.width; ++x)
        offered[std::size_t(y) * std::size_t(rays.widthPx) + std::size_t(x)].insert(r.item);
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

CoverQuery wholePicture() {
  CoverQuery query;
  query.width = query.height = kEdge;
  query.word = kWord;
  query.reach = 30.0;
  return query;
}

struct Mirror {
  const char* name;
  double bend, twist;
};

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

INSTANTIATE_TEST_SUITE_P(Exact, EveryMirror,
                         testing::Values(Mirror{"convex", -0.6, 0.0}, Mirror{"concave", 0.7, 0.0},
                                         Mirror{"saddle", 0.0, 0.6}, Mirror{"flat", 0.0, 0.0},
                                         Mirror{"wild", -1.5, 1.0}),
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
