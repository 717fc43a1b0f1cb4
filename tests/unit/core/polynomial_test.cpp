// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/polynomial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace catoptric::core {
namespace {

std::vector<double> multiply(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) product[i + k] += a[i] * b[k];
  return product;
}

TEST(RealRoots, AllOfThemAreFound) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-5, 5);
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> roots, polynomial{uniform(random) + 6};
    for (int k = 0; k < i % 5; ++k) {
      roots.push_back(uniform(random));
      polynomial = multiply(polynomial, {-roots.back(), 1});
    }
    if (i % 5 <= 2 && i % 2 == 0) polynomial = multiply(polynomial, {2 + uniform(random) / 5, 0.1, 1});
    std::sort(roots.begin(), roots.end());
    double nearest = 1;
    for (std::size_t k = 1; k < roots.size(); ++k) nearest = std::min(nearest, roots[k] - roots[k - 1]);
    if (nearest < 1e-3) continue;  // a double root may be left out
    const RealRoots found = findRealRoots(polynomial);
    ASSERT_EQ(std::size_t(found.count), roots.size());
    for (std::size_t k = 0; k < roots.size(); ++k) EXPECT_NEAR(found.values[k], roots[k], 1e-8);
  }
}

TEST(RealRoots, DegenerateInput) {
  EXPECT_EQ(findRealRoots({}).count, 0);
  const double constant[] = {3}, zero[] = {0, 0, 0}, none[] = {1, 0, 1}, linear[] = {-6, 2, 0, 0, 0};
  EXPECT_EQ(findRealRoots(constant).count, 0);
  EXPECT_EQ(findRealRoots(zero).count, 0);
  EXPECT_EQ(findRealRoots(none).count, 0);
  ASSERT_EQ(findRealRoots(linear).count, 1);
  EXPECT_EQ(findRealRoots(linear).values[0], 3);
  const double nan[] = {NAN, 1, 1};
  EXPECT_LE(findRealRoots(nan).count, 2);
}

}  // namespace
}  // namespace catoptric::core
