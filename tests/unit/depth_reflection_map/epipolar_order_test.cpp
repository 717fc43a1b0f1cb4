// SPDX-License-Identifier: Apache-2.0
// The order law: every zexel once, and along each line through the epipole nearer surfaces last.
#include "catoptric/depth_reflection_map/epipolar_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::depth_reflection_map {
namespace {

constexpr int kWidth = 61, kHeight = 40;

struct Place {
  int sheet = -1;
  int rank = -1;
};

std::vector<Place> placeZexels(const EpipolarOrder& order, int width, int height) {
  std::vector<Place> places(std::size_t(width) * std::size_t(height));
  int rank = 0, number = 0;
  for (const Sheet& sheet : order.sheets()) {
    for (const ZexelRun& run : order.runs(sheet))
      for (int k = 0; k < run.end - run.begin; ++k) {
        const int x = sheet.leftToRight ? run.begin + k : run.end - 1 - k;
        Place& place = places.at(std::size_t(run.y) * std::size_t(width) + std::size_t(x));
        EXPECT_EQ(place.rank, -1) << "twice: " << x << "," << run.y;
        place = {number, rank++};
      }
    ++number;
  }
  return places;
}

const std::vector<dvec3>& epipoles() {
  static const std::vector<dvec3> list{{30.3, 20.7, 1}, {-30.3, -20.7, -1}, {-50, 12, 1}, {200, 300, -1},
                                       {0.5, 0.5, 1},   {30.5, -900, 1},    {1, 0.5, 0},  {-1, 2, 1e-12},
                                       {0, -1, -1e-12}, {0, 0, 0},          {61, 40, 1},  {-3e8, 1e8, 1}};
  return list;
}

TEST(EpipolarOrder, TakesEveryZexelOnce) {
  EpipolarOrder order;
  for (const dvec3& e : epipoles()) {
    order.compute(kWidth, kHeight, e);
    for (const Place& place : placeZexels(order, kWidth, kHeight))
      ASSERT_GE(place.rank, 0) << e.x << "," << e.y << "," << e.z;
  }
}

/// How many pairs on a common line through the epipole are in the wrong order, of how many.
std::pair<int, int> countWrongPairs(const EpipolarOrder& order, const dvec3& e, bool isReversed) {
  const auto places = placeZexels(order, kWidth, kHeight);
  const dvec2 epipole = dvec2(e) / e.z;
  int wrong = 0, pairs = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // The zexel that is twice as far from the epipole, rounded, is on the line to within half a zexel.
      const dvec2 offset = dvec2(x + 0.5, y + 0.5) - epipole;
      const dvec2 farther = epipole + 1.5 * offset;
      const int fx = int(std::floor(farther.x)), fy = int(std::floor(farther.y));
      if (fx < 0 || fy < 0 || fx >= kWidth || fy >= kHeight || (fx == x && fy == y)) continue;
      const Place near = places[std::size_t(y) * kWidth + std::size_t(x)],
                  far = places[std::size_t(fy) * kWidth + std::size_t(fx)];
      if (near.sheet != far.sheet) continue;
      ++pairs;
      const bool nearIsLater = near.rank > far.rank;
      wrong += nearIsLater == ((e.z > 0) != isReversed) ? 0 : 1;
    }
  return {wrong, pairs};
}

TEST(EpipolarOrder, NearerSurfacesComeLast) {
  EpipolarOrder order;
  for (const dvec3& e :
       {dvec3(30.3, 20.7, 1), dvec3(-30.3, -20.7, -1), dvec3(-50, 12, 1), dvec3(80, 60, -1)}) {
    order.compute(kWidth, kHeight, e);
    const auto [wrong, pairs] = countWrongPairs(order, e, false);
    ASSERT_GT(pairs, 50);
    EXPECT_EQ(wrong, 0) << e.x << "," << e.y << "," << e.z;
    EXPECT_EQ(countWrongPairs(order, e, true).first, pairs);
  }
}

TEST(EpipolarOrder, SheetsAreManyAndAboutEquallyLarge) {
  EpipolarOrder order;
  for (const dvec3& e :
       {dvec3(-1e9, 3e8, 1), dvec3(256, 256, 1), dvec3(-300, 700, -1), dvec3(250, -5000, 1)}) {
    order.compute(512, 512, e);
    std::uint64_t largest = 0;
    for (const Sheet& sheet : order.sheets()) largest = std::max(largest, sheet.zexels);
    EXPECT_GE(order.sheets().size(), 6u);
    EXPECT_LE(largest, 512u * 512u / 5u) << e.x << "," << e.y;
  }
}

TEST(EpipolarOrder, SmallestImages) {
  EpipolarOrder order;
  order.compute(1, 1, {0.5, 0.5, 1});
  EXPECT_EQ(placeZexels(order, 1, 1)[0].rank, 0);
  order.compute(0, 0, {1, 1, 1});
  EXPECT_TRUE(order.sheets().empty());
}

}  // namespace
}  // namespace catoptric::depth_reflection_map
