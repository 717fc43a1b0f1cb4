// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/mesh_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catoptric::geometry {
namespace {

TEST(DistanceToTriangle, overTheInsideAnEdgeAndACorner) {
  const dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({1, 1, 3}, a, b, c), 3.0);
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({1, 1, -3}, a, c, b), 3.0);  // the winding does not matter
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({2, -3, 4}, a, b, c), 5.0);
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({-3, -4, 12}, a, b, c), 13.0);
  EXPECT_NEAR(computeDistanceToTriangle({3, 3, 0}, a, b, c), std::sqrt(2.0), 1e-15);
}

TEST(DistanceToTriangle, neverMoreThanToAnyOfItsPoints) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  const auto point = [&] { return dvec3(gauss(random), gauss(random), gauss(random)); };
  for (int i = 0; i < 200; ++i) {
    const dvec3 a = point(), b = point(), c = i % 5 == 0 ? a : point(), p = 2.0 * point();
    const double distance = computeDistanceToTriangle(p, a, b, c);
    double nearest = 1e300;
    for (int u = 0; u <= 40; ++u)
      for (int v = 0; u + v <= 40; ++v)
        nearest = std::min(nearest, glm::length(p - (a + (b - a) * (u / 40.0) + (c - a) * (v / 40.0))));
    EXPECT_LE(distance, nearest + 1e-12);
    EXPECT_GE(distance, nearest - 0.1);
  }
}

TEST(DistanceToTriangle, ofALineAndOfAPoint) {
  const dvec3 a(0, 0, 0), b(2, 0, 0);
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({1, 2, 0}, a, b, {1, 0, 0}), 2.0);
  EXPECT_DOUBLE_EQ(computeDistanceToTriangle({0, 3, 4}, a, a, a), 5.0);
}

}  // namespace
}  // namespace catoptric::geometry
