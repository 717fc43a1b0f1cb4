// SPDX-License-Identifier: Apache-2.0
// Solver `exact` by the processor: each pixel gets the triangle that its ray meets first, by brute force in
// double, and what only GL can judge is handed on. The twin has rays that were turned, and must differ.
#include "catoptric/virtual_object/exact/tile_hits.h"

#include <gtest/gtest.h>

#include <bit>

#include "catoptric/virtual_object/formulas.h"
#include "exact_rays.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();
constexpr float kDepthFromDistance = 0.01f;

struct Found {
  Cover cover;
  HitImage image;
};

Found findHits(const TriangleHierarchy& hierarchy, const RayImages& rays, const CoverQuery& query) {
  Found found;
  TileHits(hierarchy).compute(rays, query, kDepthFromDistance, found.cover, found.image);
  return found;
}

/// Pixels whose distance is not that of the nearest triangle; two may be equally near, and a grazing one
/// loses digits.
int countWrong(const RayImages& rays, std::span<const HierarchyTriangle> triangles, const CoverQuery& query,
               const HitImage& image, int& hits) {
  int wrong = 0;
  hits = 0;
  for (int y = 0; y < query.height; ++y)
    for (int x = 0; x < query.width; ++x) {
      const std::size_t ray = std::size_t(query.y + y) * std::size_t(rays.widthPx) + std::size_t(query.x + x);
      double nearest = kMiss, grazed = kMiss;  // what a rounding away may be met or not
      for (const HierarchyTriangle& t : triangles) {
        if (rays.words[ray].y != query.word || t.part == query.excludedPart) continue;
        nearest = std::min(nearest, meet(rays.origins[ray], rays.directions[ray], t));
        for (const float off : {-1e-5f, 1e-5f})
          for (int axis = 0; axis < 3; ++axis) {
            vec4 beside = rays.origins[ray];
            beside[axis] += off;
            grazed = std::min(grazed, meet(beside, rays.directions[ray], t));
          }
      }
      const std::size_t pixel = std::size_t(y) * std::size_t(query.width) + std::size_t(x);
      const uvec2 hit = image.hits[pixel];
      const double distance = hit.x == 0 ? kMiss : double(std::bit_cast<float>(hit.y));
      hits += hit.x != 0 ? 1 : 0;
      const auto isAt = [&](double expected) {
        return distance == expected || std::abs(distance - expected) < 1e-3 * expected + 1e-6;
      };
      wrong += isAt(nearest) || isAt(grazed) ? 0 : 1;
      if (hit.x != 0) {
        EXPECT_FLOAT_EQ(image.depths[pixel], float(distance) * kDepthFromDistance);
      } else {
        EXPECT_EQ(image.depths[pixel], 1.0f);
      }
    }
  return wrong;
}

class EveryMirrorsHits : public testing::TestWithParam<Mirror> {};

TEST_P(EveryMirrorsHits, AreTheTrianglesThatItsPixelsSee) {
  std::mt19937 random(5);
  for (const double size : {0.05, 0.4, 3.0}) {
    const TriangleHierarchy hierarchy(makeTriangles(400, size, random));
    const RayImages rays = makeRays(GetParam().bend, GetParam().twist);
    CoverQuery query = wholePicture();
    query.x = 5, query.y = 3, query.width = 40, query.height = 41;  // tiles that are cut off
    int hits = 0;
    EXPECT_EQ(countWrong(rays, hierarchy.triangles(), query, findHits(hierarchy, rays, query).image, hits), 0)
        << "triangles of " << size;
    EXPECT_GT(hits, size > 0.1 ? 100 : 0);
    const Found turned = findHits(hierarchy, makeRays(GetParam().bend, GetParam().twist, 0.2), query);
    EXPECT_GT(countWrong(rays, hierarchy.triangles(), query, turned.image, hits), size > 0.1 ? 20 : -1);
  }
}

INSTANTIATE_TEST_SUITE_P(Exact, EveryMirrorsHits, testing::ValuesIn(kMirrors),
                         [](const auto& mirror) { return mirror.param.name; });

/// Eight rays side by side meet what the shader's text says, to the bit.
TEST(RayLanesTest, AreTheFormulaThatShadersHave) {
  std::mt19937 random(9);
  const RayImages rays = makeRays(0.7, 0.3);
  RayLanes lanes;
  int hits = 0;
  for (const HierarchyTriangle& t : makeTriangles(60, 1.5, random)) {
    const vec3 normal = glm::cross(t.b - t.a, t.c - t.a);
    const bool isSingleSided = (t.flags & kCoverSingleSided) != 0;
    const RayLanes::Test test{t.a, t.b, t.c, normal, t.triangle, isSingleSided};
    lanes.assign(rays.origins, rays.directions);
    lanes.meet(std::span(&test, 1));
    for (std::size_t i = 0; i < rays.origins.size(); ++i) {
      const vec3 o(rays.origins[i]);
      const formulas::RayHit hit = formulas::meetTriangle(vec3(rays.directions[i]), rays.directions[i].w,
                                                          t.a - o, t.b - o, t.c - o, normal);
      const bool isHit = hit.isHit && (hit.isFront || !isSingleSided);
      EXPECT_EQ(lanes.triangle(i), isHit ? t.triangle : core::kNoId);
      EXPECT_EQ(lanes.distance(i), isHit ? hit.t : std::numeric_limits<float>::infinity());
      hits += isHit ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(TileHitsTest, HandOnWhatATextureMayCutOut) {
  std::mt19937 random(5);
  std::vector<HierarchyTriangle> triangles = makeTriangles(400, 0.5, random);
  for (HierarchyTriangle& t : triangles)
    if (t.part == 1) t.flags |= kCoverMasked;
  const TriangleHierarchy hierarchy(triangles);
  const RayImages rays = makeRays(-0.6, 0.0);
  const Found found = findHits(hierarchy, rays, wholePicture());
  for (const CoverRect& r : found.cover.masked) EXPECT_EQ(triangles[r.item].part, 1u);
  const auto offered = findOffered(rays, found.cover.masked);
  int seen = 0;
  for (std::size_t ray = 0; ray < rays.origins.size(); ++ray) {
    if (rays.words[ray].y != kWord) continue;
    const uvec2 hit = found.image.hits[ray];
    EXPECT_TRUE(hit.x == 0 || triangles[hit.x - 1].part != 1u);
    const double distance = hit.x == 0 ? kMiss : double(std::bit_cast<float>(hit.y));
    for (const HierarchyTriangle& t : triangles)
      if (t.part == 1 && meet(rays.origins[ray], rays.directions[ray], t) < 0.999 * distance) {
        ++seen;
        EXPECT_TRUE(offered[ray].contains(t.triangle));
      }
  }
  EXPECT_GT(seen, 50);
}

TEST(TileHitsTest, LeaveOutTheExcludedPartAndAnswerAnEmptyScene) {
  std::mt19937 random(5);
  const std::vector<HierarchyTriangle> triangles = makeTriangles(300, 0.5, random);
  const TriangleHierarchy hierarchy(triangles), nothing({});
  const RayImages rays = makeRays(-0.5, 0.0);
  CoverQuery query = wholePicture();
  query.excludedPart = 2;
  const Found found = findHits(hierarchy, rays, query);
  int hits = 0;
  EXPECT_EQ(countWrong(rays, triangles, query, found.image, hits), 0);
  EXPECT_GT(hits, 100);
  for (const uvec2& hit : found.image.hits) EXPECT_TRUE(hit.x == 0 || triangles[hit.x - 1].part != 2u);
  for (const uvec2& hit : findHits(nothing, rays, query).image.hits) EXPECT_EQ(hit.x, 0u);
}

}  // namespace
}  // namespace catoptric::virtual_object
