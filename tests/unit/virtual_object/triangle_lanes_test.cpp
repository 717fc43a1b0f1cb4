// SPDX-License-Identifier: Apache-2.0
// Eight triangles side by side say of every pixel what integers of 64 bits say of one triangle.
#include "catoptric/virtual_object/triangle_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace catoptric::virtual_object {
namespace {

constexpr gl::Scissor kBounds{40, 30, 90, 70};
constexpr int kLanes = TriangleGroup::kLanes, kSub = TriangleGroup::kSub;

/// One lane's triangle, with the top-left rule.
struct Reference {
  std::array<std::int64_t, 3> x, y;

  Reference(const TriangleGroup& g, int lane) {
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = std::llrint(double(g.x[k][lane]) * kSub) - kBounds.x * kSub,
      y[k] = std::llrint(double(g.y[k][lane]) * kSub) - kBounds.y * kSub;
    if (area() < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]);
  }
  [[nodiscard]] std::int64_t area() const {
    return (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  }
  [[nodiscard]] bool holds(int column, int row) const {
    const std::int64_t px = column * kSub + kSub / 2, py = row * kSub + kSub / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = k, b = (k + 1) % 3;
      const std::int64_t dx = x[b] - x[a], dy = y[b] - y[a], edge = dx * (py - y[a]) - dy * (px - x[a]);
      if (edge < 0 || (edge == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
    }
    return area() > 0;
  }
};

bool isInside(const TriangleGroup& g, int lane, int column, int row) {
  const int i = column - g.x0[lane], j = row - g.y0[lane];
  if (i < 0 || j < 0 || i >= g.width[lane] || j >= g.height[lane]) return false;
  if ((g.tiny >> lane & 1u) != 0)
    return (std::uint32_t(g.inside[j / 4][lane]) >> (8 * (j % 4) + i) & 1u) != 0;
  for (int k = 0; k < 3; ++k)
    if (g.edge[k][lane] + i * g.stepX[k][lane] + j * g.stepY[k][lane] < 0) return false;
  return true;
}

/// Triangles of `size` pixels about the bounds. Corners on a grid of half pixels: many centres lie on edges.
TriangleGroup makeGroup(std::mt19937& random, float size) {
  std::uniform_real_distribution<float> at(-20, 120), offset(-0.5f * size, 0.5f * size);
  TriangleGroup g;
  g.wanted = 0xffu;
  for (int lane = 0; lane < kLanes; ++lane) {
    const float x = float(kBounds.x) + at(random), y = float(kBounds.y) + at(random);
    for (int k = 0; k < 3; ++k) {
      g.x[k][lane] = std::round(2 * (x + offset(random))) / 2;
      g.y[k][lane] = std::round(2 * (y + offset(random))) / 2;
      g.nearness[k][lane] = 1.0f + 0.1f * float(k);
    }
  }
  return g;
}

void expectSameAsReference(float size, unsigned& tiny, unsigned& small) {
  std::mt19937 random(3);
  for (int round = 0; round < 40; ++round) {
    TriangleGroup g = makeGroup(random, size);
    setUpTriangles(kBounds, g);
    EXPECT_EQ(g.hard, 0u);
    EXPECT_EQ(g.tiny & g.small, 0u);
    tiny |= g.tiny, small |= g.small;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Reference reference(g, lane);
      const bool isDrawn = ((g.tiny | g.small) >> lane & 1u) != 0;
      for (int row = 0; row < kBounds.height; ++row)
        for (int column = 0; column < kBounds.width; ++column)
          ASSERT_EQ(isDrawn && isInside(g, lane, column, row), reference.holds(column, row))
              << round << ' ' << lane << ' ' << column << ' ' << row;
    }
  }
}

TEST(TriangleLanes, SayWhatIntegersSay) {
  unsigned tiny = 0, small = 0;
  for (const float size : {1.5f, 5.0f, 14.0f, 40.0f}) expectSameAsReference(size, tiny, small);
  EXPECT_EQ(tiny, 0xffu);
  EXPECT_EQ(small, 0xffu);
}

TEST(TriangleLanes, NearnessIsThatOfTheCorners) {
  std::mt19937 random(5);
  TriangleGroup g = makeGroup(random, 30);
  setUpTriangles(kBounds, g);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (((g.tiny | g.small) >> lane & 1u) == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const float x = g.x[k][lane] - float(kBounds.x) - float(g.x0[lane]) - 0.5f;
      const float y = g.y[k][lane] - float(kBounds.y) - float(g.y0[lane]) - 0.5f;
      EXPECT_NEAR(g.near[lane] + x * g.nearX[lane] + y * g.nearY[lane], g.nearness[k][lane], 1e-4);
    }
    EXPECT_EQ(g.least[lane], 1.0f);
    EXPECT_EQ(g.most[lane], 1.2f);
  }
}

TEST(TriangleLanes, WhatDoesNotFitIsHard) {
  std::mt19937 random(7);
  TriangleGroup g = makeGroup(random, 5);
  for (int lane = 0; lane < kLanes; ++lane) {
    g.x[0][lane] = 70, g.x[1][lane] = 75, g.x[2][lane] = 71;
    g.y[0][lane] = 50, g.y[1][lane] = 51, g.y[2][lane] = 55;
  }
  g.x[1][0] = std::numeric_limits<float>::quiet_NaN();
  g.y[2][1] = std::numeric_limits<float>::infinity();
  g.x[0][2] = -25000, g.y[0][2] = -3e9f;
  g.x[1][3] = 70 + float(TriangleGroup::kLargestPx) + 1;
  g.y[0][4] = g.y[1][4] = g.y[2][4] = 52;       // no area
  for (int k = 0; k < 3; ++k) g.x[k][5] -= 60;  // beside the bounds
  g.wanted = 0xbfu;
  setUpTriangles(kBounds, g);
  EXPECT_EQ(g.hard, 0x0fu);
  EXPECT_EQ(g.tiny, 0x80u);
  EXPECT_EQ(g.small, 0u);
}

}  // namespace
}  // namespace catoptric::virtual_object
