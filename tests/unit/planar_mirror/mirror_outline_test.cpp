// SPDX-License-Identifier: Apache-2.0
// Outlines of flat mirrors and the planes through the eye and their edges: laws on small meshes.
#include "catoptric/planar_mirror/mirror_outline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "catoptric/planar_mirror/mirrored_view.h"

namespace catoptric::planar_mirror {
namespace {

/// A fan of triangles around the first corner, as the mirror of a world of its own.
scene::WorldGeometry makeMirrorOf(const std::vector<vec3>& corners,
                                  const std::vector<std::uint32_t>& indices) {
  scene::WorldGeometry world;
  world.positions = corners;
  world.indices = indices;
  world.parts.push_back({0, std::uint32_t(indices.size()), 0, std::uint32_t(corners.size())});
  world.parts[0].reflector = 0;
  world.reflectors.emplace_back();
  return world;
}

TEST(MirrorOutline, isThatOfAQuad) {
  const auto world = makeMirrorOf({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3});
  EXPECT_EQ(findConvexOutline(world, 0, 7).size(), 4u);
  EXPECT_TRUE(findConvexOutline(world, 0, 3).empty());  // more corners than planes
}

TEST(MirrorOutline, leavesOutCornersOnStraightEdgesAndInside) {
  // A grid of 2 x 2 cells: nine vertices, four corners.
  std::vector<vec3> corners;
  std::vector<std::uint32_t> indices;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) corners.emplace_back(x, y, 0.5f);
  for (std::uint32_t y = 0; y < 2; ++y)
    for (std::uint32_t x = 0; x < 2; ++x) {
      const std::uint32_t a = 3 * y + x;
      indices.insert(indices.end(), {a, a + 1, a + 4, a, a + 4, a + 3});
    }
  const std::vector<dvec3> outline = findConvexOutline(makeMirrorOf(corners, indices), 0, 7);
  ASSERT_EQ(outline.size(), 4u);
  for (const dvec3& corner : outline) EXPECT_TRUE(corner.x != 1.0 && corner.y != 1.0);
}

TEST(MirrorOutline, isNothingForWhatIsNotOneConvexPolygon) {
  const auto isEmpty = [](const std::vector<vec3>& corners, const std::vector<std::uint32_t>& indices) {
    return findConvexOutline(makeMirrorOf(corners, indices), 0, 7).empty();
  };
  const std::vector<vec3> ell{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_TRUE(isEmpty(ell, {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5}));
  const std::vector<vec3> two{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}};
  EXPECT_TRUE(isEmpty(two, {0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(isEmpty({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2}));           // no area
  EXPECT_TRUE(isEmpty({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 1, 2}));  // upon each other
  EXPECT_TRUE(isEmpty({}, {}));
}

raster::PinholeView lookDown() {
  raster::PinholeView view;
  view.eye = {0.3, 0.2, 5};
  view.rayOrigin = {-0.5, -0.5, -1};
  view.rayDx = {0.01, 0, 0};
  view.rayDy = {0, 0.01, 0};
  return view;
}

TEST(EdgePlanes, holdTheMirrorAndOnePixelAroundIt) {
  const std::vector<dvec3> quad{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const raster::PinholeView view = lookDown();
  const std::vector<vec4> planes = makeEdgePlanes(quad, view);
  ASSERT_EQ(planes.size(), 4u);
  const auto isInside = [&](const dvec3& p) {
    for (const vec4& plane : planes)
      if (glm::dot(dvec3(vec3(plane)), p) + double(plane.w) < 0.0) return false;
    return true;
  };
  const double pixel = 0.01 * 5;
  for (const dvec3& corner : quad) {
    EXPECT_TRUE(isInside(corner));
    EXPECT_TRUE(isInside(glm::mix(view.eye, corner, 3.0)));  // whatever its distance
    EXPECT_TRUE(isInside(corner * (1.0 + 0.5 * pixel)));
    EXPECT_FALSE(isInside(corner * (1.0 + 3.0 * pixel)));
  }
}

TEST(FrustumSides, holdWhatTheRectangleShowsHoweverItIsMirrored) {
  raster::PinholeView view = lookDown();
  for (const double mirrored : {1.0, -1.0}) {
    view.rayDx.x = 0.01 * mirrored;
    const std::array<vec4, 4> sides = makeFrustumSides(view, {20, 30, 40, 10});
    const auto isInside = [&](double x, double y) {
      const dvec3 p = view.eye + 7.0 * (view.rayOrigin + x * view.rayDx + y * view.rayDy);
      return std::all_of(sides.begin(), sides.end(), [&](const vec4& side) {
        return glm::dot(dvec3(vec3(side)), p) + double(side.w) > 0.0;
      });
    };
    EXPECT_TRUE(isInside(21, 31) && isInside(59, 39));
    EXPECT_FALSE(isInside(19, 35) || isInside(61, 35) || isInside(40, 29) || isInside(40, 41));
  }
}

TEST(ReducedView, seesTheSameThroughThePixelsOfItsRectangle) {
  raster::PinholeView view = lookDown();
  view.clipFromWorld = dmat4(1.0);  // any projection will do
  view.clipFromWorld[2][3] = -0.5;
  const gl::Scissor rectangle{12, 20, 30, 16};
  const raster::PinholeView reduced = reduceToRectangle(view, rectangle, 100, 80, 15, 8);
  const dvec4 point(0.2, -0.1, -0.7, 1.0);
  const dvec4 whole = view.clipFromWorld * point, part = reduced.clipFromWorld * point;
  const dvec2 pixel = (dvec2(whole) / whole.w * 0.5 + 0.5) * dvec2(100, 80);
  const dvec2 texel = (dvec2(part) / part.w * 0.5 + 0.5) * dvec2(15, 8);
  EXPECT_NEAR(texel.x, (pixel.x - 12) * 0.5, 1e-9);
  EXPECT_NEAR(texel.y, (pixel.y - 20) * 0.5, 1e-9);
  const dvec3 ray = reduced.rayOrigin + texel.x * reduced.rayDx + texel.y * reduced.rayDy;
  const dvec3 expected = view.rayOrigin + pixel.x * view.rayDx + pixel.y * view.rayDy;
  EXPECT_LT(glm::length(ray - expected), 1e-9);
}

}  // namespace
}  // namespace catoptric::planar_mirror
