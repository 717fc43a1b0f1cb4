// SPDX-License-Identifier: Apache-2.0
// A virtual object for each interval between foci: each image of a point is found in the interval it belongs
// to, and nowhere else.
#include "catoptric/virtual_object/mixed/interval_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "catoptric/geometry/sampled_surface.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

/// z = (a x^2 + b y^2) / 2 over a square around the origin, bright side +z: positive is hollow.
ReflectorMesh makeDish(double a, double b, double half) {
  return meshOf(geometry::makeHeightField(
      61, 61, [half](dvec2 s) { return half * s; },
      [a, b](dvec2 p) {
        return geometry::HeightSample{0.5 * (a * p.x * p.x + b * p.y * p.y), a * p.x, b * p.y};
      }));
}

const dvec3 kEye(0.2, 0.1, 3);

/// What the middle of a triangle shows at a distance.
dvec3 pointAlong(const MirrorTriangle& t, double distance) {
  return t.position(1.0 / 3, 1.0 / 3) + distance * reflectAt(t, 1.0 / 3, 1.0 / 3, kEye);
}

struct Count {
  std::size_t tried = 0, found = 0;
};

/// Of rays that leave a dish, followed to a share of the way between foci: is J found again, in that
/// interval? Each point is also sought in the others; what is found there must lie in them.
std::array<Count, kIntervals> followRays(const ReflectorMesh& mesh) {
  const IntervalSearch search(mesh, kEye);
  std::array<Count, kIntervals> counts;
  for (std::size_t i = 5; i < mesh.ordinaryCount(); i += 37) {
    const MirrorTriangle& t = mesh.triangles()[i];
    const auto foci = findFocalDistances(t, kEye);
    const double past = std::isfinite(foci[0]) ? foci[0] : 1.0;
    for (const double distance :
         {0.3 * past, 0.7 * past, 0.5 * (foci[0] + foci[1]), 1.5 * foci[0], 1.6 * foci[1], 3 * foci[1]}) {
      const bool isNear =
          std::abs(distance - foci[0]) < 0.2 * foci[0] || std::abs(distance - foci[1]) < 0.2 * foci[1];
      if (!std::isfinite(distance) || isNear) continue;
      const std::size_t interval = findInterval(t, kEye, 1.0 / 3, 1.0 / 3, distance);
      const dvec3 point = pointAlong(t, distance);
      const auto back = search.find(point, interval);
      ++counts[interval].tried;
      counts[interval].found += back && glm::distance(*back, t.position(1.0 / 3, 1.0 / 3)) < 1e-3 ? 1 : 0;
    }
  }
  return counts;
}

TEST(IntervalSearch, findsTheRayThatShowsAPointInItsInterval) {
  for (const dvec2 c : {dvec2(0.9, 0.5), dvec2(0.7, -0.6), dvec2(1.2, 0.6)}) {
    const auto counts = followRays(makeDish(c.x, c.y, 0.4));
    const std::size_t intervals = c.y > 0 ? 3 : 2;
    for (std::size_t k = 0; k < kIntervals; ++k) {
      if (k < intervals)
        EXPECT_GT(counts[k].tried, 20u);
      else
        EXPECT_EQ(counts[k].tried, 0u);
      EXPECT_GE(double(counts[k].found), 0.98 * double(counts[k].tried)) << c.x << ' ' << c.y << ' ' << k;
    }
  }
}

TEST(IntervalSearch, aPointMayHaveAnImageInEach) {
  // A trough, hollow across x: past the focal line of its middle, a point above shows at the middle,
  // reversed, and at the sides, whose focal distances are longer.
  const ReflectorMesh mesh = meshOf(geometry::makeHeightField(
      81, 21, [](dvec2 s) { return dvec2(0.9 * s.x, 0.3 * s.y); },
      [](dvec2 p) {
        const double x2 = p.x * p.x;
        return geometry::HeightSample{0.5 * x2 - 0.32 * x2 * x2, p.x - 1.28 * p.x * x2, 0};
      }));
  const dvec3 eye(0, 0, 3), point(0, 0.02, 1.2);
  const IntervalSearch search(mesh, eye);
  const std::vector<vec3> points{vec3(point)};
  std::array<IntervalVertices, kIntervals> found;
  search.compute(points, {}, {true, true, false}, found);
  ASSERT_EQ(found[0].kinds[0], raster::VertexKind::Reflected);
  ASSERT_EQ(found[1].kinds[0], raster::VertexKind::Reflected);
  EXPECT_GT(std::abs(found[0].reflectionPoints[0].x), 0.1f);
  EXPECT_LT(std::abs(found[1].reflectionPoints[0].x), 0.01f);
  EXPECT_TRUE(found[2].kinds.empty());  // not wanted
  for (std::size_t k = 0; k < 2; ++k) {
    const dvec3 j(found[k].reflectionPoints[0]);
    const double path = glm::distance(eye, j) + glm::distance(j, point);
    EXPECT_NEAR(glm::distance(eye, dvec3(found[k].positions[0])), path, 1e-5);
  }
}

TEST(IntervalSearch, degenerateInputHasNoImages) {
  std::array<IntervalVertices, kIntervals> found;
  const ReflectorMesh nothing = meshOf(geometry::Mesh{}), dish = makeDish(0.5, 0.5, 0.3);
  EXPECT_FALSE(IntervalSearch(nothing, kEye).canReflect());
  EXPECT_FALSE(IntervalSearch(dish, dvec3(0, 0, -3)).canReflect());
  EXPECT_FALSE(IntervalSearch(dish, dvec3(NAN)).canReflect());
  EXPECT_FALSE(IntervalSearch(nothing, kEye).find(dvec3(0), 0).has_value());
  const std::vector<vec3> points{vec3(NAN), vec3(0, 0, -1)};
  IntervalSearch(dish, kEye).compute(points, {}, {true, true, true}, found);
  for (const IntervalVertices& vertices : found)
    for (const raster::VertexKind kind : vertices.kinds) EXPECT_EQ(kind, raster::VertexKind::None);
}

}  // namespace
}  // namespace catoptric::virtual_object
