// SPDX-License-Identifier: Apache-2.0
// Where the cubes of a curved mirror are taken from.
#include "catoptric/depth_reflection_map/inverse_warp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catoptric::depth_reflection_map {
namespace {

/// A cap of the unit sphere around the origin, 0.3 in radius, around -z; normals inwards (concave) or
/// outwards.
ReflectorOutline makeCap(double sign) {
  ReflectorOutline outline;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.3 * std::sqrt((i + 0.5) / 60), angle = 2.4 * i;
    const dvec3 p(r * std::cos(angle), r * std::sin(angle), -std::sqrt(1 - r * r));
    outline.samples.push_back({p, -sign * p});
    outline.middle += p / 60.0;
    outline.normal += -sign * p / 60.0;
  }
  return outline;
}

TEST(InverseWarp, EyeImageOfAConcaveSphereIsThatOfTheMirrorEquation) {
  // 1 / eye + 1 / image = 2 / radius, distances from the mirror.
  for (const double eye : {3.0, 1.6}) {
    const auto image = findEyeImage(makeCap(1), {0, 0, eye - 1});
    ASSERT_TRUE(image.has_value());
    EXPECT_NEAR(image->z + 1, 1 / (2 - 1 / eye), 0.03) << eye;
    EXPECT_NEAR(std::hypot(image->x, image->y), 0, 0.01);
  }
}

TEST(InverseWarp, FirstCubeIsAtTheEyeImageWhereThatLiesBeforeTheMirror) {
  scene::Reflector mirror;
  mirror.radius = 0.3;
  const dvec3 eye(0.1, 0, 2);
  const auto concave = makeCubeCentres(mirror, makeCap(1), eye);
  ASSERT_EQ(concave.size(), 2u);
  EXPECT_LT(glm::distance(concave[0], *findEyeImage(makeCap(1), eye)), 0.05 * 0.3);
  // A convex one has it behind: the first cube is before its middle.
  const auto convex = makeCubeCentres(mirror, makeCap(-1), {0, 0, -4});
  ASSERT_GT(convex.size(), 2u);
  EXPECT_LT(convex[0].z, -1.0);
}

TEST(InverseWarp, ParallelRaysMeetNowhere) {
  ReflectorOutline plane;
  for (int i = 0; i < 9; ++i) plane.samples.push_back({{i % 3, i / 3, 0}, {0, 0, 1}});
  EXPECT_FALSE(findEyeImage(plane, {0, 0, 1e9}).has_value());
}

}  // namespace
}  // namespace catoptric::depth_reflection_map
