// SPDX-License-Identifier: Apache-2.0
// Rectangles around mirrors hold all that is seen of them, and little more.
#include "catoptric/renderer/mirror_rects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace catoptric::renderer {
namespace {

constexpr int kWidth = 400, kHeight = 300;

dmat4 makeClip() {
  return glm::perspective(0.9, double(kWidth) / kHeight, 0.05, 100.0) *
         glm::lookAt(dvec3(1, 2, 3), dvec3(0, 0.5, 0), dvec3(0, 1, 0));
}

/// Of the picture, what points of a sphere before the eye come to lie in.
struct Seen {
  int x0 = kWidth, y0 = kHeight, x1 = -1, y1 = -1;
};

Seen sample(const dmat4& clip, const dvec3& centre, double radius) {
  Seen seen;
  for (int i = 0; i < 200; ++i)
    for (int k = 0; k < 400; ++k) {
      const double z = -1.0 + 2.0 * (i + 0.5) / 200, angle = k * 2 * 3.14159265358979 / 400,
                   r = std::sqrt(1 - z * z);
      const dvec4 p = clip * dvec4(centre + radius * dvec3(r * std::cos(angle), r * std::sin(angle), z), 1.0);
      const double x = (p.x / p.w + 1) * 0.5 * kWidth, y = (p.y / p.w + 1) * 0.5 * kHeight;
      if (!(p.w > 0) || x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
      seen = {std::min(seen.x0, int(x)), std::min(seen.y0, int(y)), std::max(seen.x1, int(x)),
              std::max(seen.y1, int(y))};
    }
  return seen;
}

TEST(MirrorRects, HoldASphereAndLittleMore) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-2.5, 2.5), size(0.05, 1.2);
  int tight = 0;
  for (int i = 0; i < 40; ++i) {
    const dvec3 centre(place(random), place(random), place(random));
    const double radius = size(random);
    const Seen seen = sample(makeClip(), centre, radius);
    const auto rect = findSphereRect(makeClip(), centre, radius, kWidth, kHeight);
    if (seen.x1 < 0) continue;
    ASSERT_TRUE(rect) << i;
    EXPECT_LE(rect->x, seen.x0);
    EXPECT_LE(rect->y, seen.y0);
    EXPECT_GT(rect->x + rect->width, seen.x1);
    EXPECT_GT(rect->y + rect->height, seen.y1);
    const bool isWithin = seen.x0 > 8 && seen.y0 > 8 && seen.x1 < kWidth - 9 && seen.y1 < kHeight - 9;
    if (!isWithin) continue;
    ++tight;
    EXPECT_LE(rect->width, seen.x1 - seen.x0 + 9);
    EXPECT_LE(rect->height, seen.y1 - seen.y0 + 9);
  }
  EXPECT_GT(tight, 3);
}

TEST(MirrorRects, AroundTheEyeIsEverywhereAndBehindItNowhere) {
  const auto around = findSphereRect(makeClip(), dvec3(1, 2, 3.1), 0.5, kWidth, kHeight);
  ASSERT_TRUE(around);
  EXPECT_EQ(around->width, kWidth);
  EXPECT_EQ(around->height, kHeight);
  EXPECT_FALSE(findSphereRect(makeClip(), dvec3(3, 5, 9), 0.5, kWidth, kHeight));
  EXPECT_FALSE(findSphereRect(makeClip(), dvec3(-40, 0, -3), 0.5, kWidth, kHeight));
}

TEST(MirrorRects, AMirrorSeenAslantHasARectangleOfItsOwn) {
  // A low, wide mirror of five triangles in a fan.
  scene::WorldGeometry world;
  for (int i = 0; i < 7; ++i)
    world.positions.emplace_back(-0.9f + 0.3f * float(i), 0.5f + 0.1f * float(i % 2), 0);
  world.parts.resize(1);
  world.parts[0].vertexCount = 7;
  world.reflectors.resize(1);
  world.reflectors[0].centre = dvec3(0, 0.55, 0), world.reflectors[0].radius = 0.91;
  const auto sphere = findSphereRect(makeClip(), dvec3(0, 0.55, 0), 0.91, kWidth, kHeight);
  const auto rects = findMirrorRects(world, makeClip(), kWidth, kHeight);
  ASSERT_EQ(rects.size(), 1u);
  EXPECT_LT(rects[0].width * rects[0].height, sphere->width * sphere->height / 3);
  for (const vec3& point : world.positions) {
    const dvec4 at = makeClip() * dvec4(dvec3(point), 1.0);
    const double x = (at.x / at.w + 1) * 0.5 * kWidth, y = (at.y / at.w + 1) * 0.5 * kHeight;
    EXPECT_TRUE(x > rects[0].x + 1 && x < rects[0].x + rects[0].width - 1) << x;
    EXPECT_TRUE(y > rects[0].y + 1 && y < rects[0].y + rects[0].height - 1) << y;
  }
  // One corner behind the eye: then the sphere decides.
  world.positions[0] = vec3(3, 5, 9);
  const auto again = findMirrorRects(world, makeClip(), kWidth, kHeight);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].width, sphere->width);
}

TEST(MirrorRects, ManyBecomeOne) {
  scene::WorldGeometry world;
  world.parts.resize(1);
  world.reflectors.resize(2);
  world.reflectors[0].centre = dvec3(-0.5, 0.5, 0), world.reflectors[0].radius = 0.2;
  world.reflectors[1].centre = dvec3(0.5, 0.5, 0), world.reflectors[1].radius = 0.2;
  EXPECT_EQ(findMirrorRects(world, makeClip(), kWidth, kHeight).size(), 2u);
  world.reflectors.resize(40, world.reflectors[0]);
  const auto rects = findMirrorRects(world, makeClip(), kWidth, kHeight);
  ASSERT_EQ(rects.size(), 1u);
  EXPECT_EQ(rects[0].width, kWidth);
  world.reflectors.clear();
  EXPECT_TRUE(findMirrorRects(world, makeClip(), kWidth, kHeight).empty());
}

}  // namespace
}  // namespace catoptric::renderer
