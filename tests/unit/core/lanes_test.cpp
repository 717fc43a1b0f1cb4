// SPDX-License-Identifier: Apache-2.0
// Eight numbers at a time against the standard library, one by one.
#include "catoptric/core/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "catoptric/core/lane_vectors.h"

namespace catoptric::core::lanes {
namespace {

Float spread(float from, float step) {
  Float a;
  for (int i = 0; i < kLanes; ++i) a.v[i] = from + step * float(i);
  return a;
}

/// Largest difference of of(a) and the standard's from `from` on.
template <class Of, class Standard>
double findError(float from, float to, const Of& of, const Standard& standard) {
  double most = 0;
  constexpr int kSteps = 2000;
  const float step = (to - from) / (8 * kSteps);
  for (int k = 0; k < kSteps; ++k) {
    const Float a = spread(from + 8.0f * step * float(k), step), b = of(a);
    for (int i = 0; i < kLanes; ++i)
      most = std::max(most, std::abs(double(b.v[i]) - standard(double(a.v[i]))));
  }
  return most;
}

TEST(Lanes, functionsAreTheStandardsWithinWhatTheyState) {
  EXPECT_LT(findError(
                -1, 1, [](Float a) { return acos(a); }, [](double a) { return std::acos(a); }),
            3e-6);
  EXPECT_LT(findError(
                0.01f, 900, [](Float a) { return log2(a); }, [](double a) { return std::log2(a); }),
            3e-6);
  EXPECT_LT(findError(
                -20, 1, [](Float a) { return exp2(a); }, [](double a) { return std::exp2(a); }),
            1e-6);
  EXPECT_EQ(findError(
                -70, 90, [](Float a) { return floor(a); }, [](double a) { return std::floor(a); }),
            0.0);
  for (const float x : {-2.0f, -0.3f, 0.0f, 0.7f})
    EXPECT_LT(
        findError(
            -3, 3, [&](Float y) { return atan(y, x); }, [&](double y) { return std::atan2(y, double(x)); }),
        2e-6)
        << x;
}

TEST(Lanes, noAnswerIsStillANumber) {
  EXPECT_EQ(atan(0.0f, 0.0f).v[3], 0.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(clamp(nan, 2.0f, 3.0f).v[0], 2.0f);  // whatever comes out of it can be an index
}

TEST(Lanes, areAlignedForTheWidestVectors) {
  static_assert(alignof(Float) == sizeof(Eight) && alignof(Mask) == sizeof(Eight) &&
                alignof(Vec3) == sizeof(Eight));
  const std::vector<Vec3> some(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(some.data()) % sizeof(Eight), 0u);
}

TEST(Lanes, eachLaneChoosesForItself) {
  const Float a = spread(0, 1);
  const Mask isSmall = a < 3.0f;
  const Vec3 chosen = choose(isSmall, Vec3(1.0f), Vec3(a, 2.0f * a, -a));
  for (int i = 0; i < kLanes; ++i) {
    EXPECT_EQ(chosen.y.v[i], i < 3 ? 1.0f : 2.0f * float(i));
    EXPECT_EQ(chosen.z.v[i], i < 3 ? 1.0f : -float(i));
  }
  EXPECT_TRUE(anyLane(isSmall));
  EXPECT_FALSE(anyLane(isSmall && a > 2.5f));
  EXPECT_TRUE(anyLane(!isSmall));
}

TEST(Lanes, rowsBecomeColumns) {
  vec4 table[kLanes];
  const vec4* rows[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    table[i] = vec4(float(i), 10.0f + float(i), 20.0f + float(i), 30.0f + float(i));
    rows[i] = &table[i];
  }
  const Vec4 columns = loadRows(rows);
  for (int i = 0; i < kLanes; ++i)
    for (int k = 0; k < 4; ++k) EXPECT_EQ(columns[k].v[i], table[i][k]);
}

TEST(Lanes, refractionIsGlms) {
  const Vec3 v = normalize(Vec3(spread(-0.9f, 0.25f), -1.0f, 0.3f)), n(0.0f, 1.0f, 0.0f);
  for (const float eta : {0.66f, 1.5f}) {
    const Vec3 here = refract(v, n, eta);
    for (int i = 0; i < kLanes; ++i) {
      const vec3 there = glm::refract(vec3(v.x.v[i], v.y.v[i], v.z.v[i]), vec3(0, 1, 0), eta);
      EXPECT_NEAR(here.x.v[i], there.x, 1e-6);
      EXPECT_NEAR(here.y.v[i], there.y, 1e-6);
    }
  }
}

}  // namespace
}  // namespace catoptric::core::lanes
