// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/triangle_lanes.h"

#include <algorithm>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::load;
using core::store;
using core::toBits;

constexpr int kSub = TriangleGroup::kSub;

CATOPTRIC_INLINE void store(std::int32_t* to, const EightInts& value) {
  std::memcpy(to, &value, sizeof value);
}

CATOPTRIC_INLINE EightInts smaller(const EightInts& a, const EightInts& b) {
  return a < b ? a : b;
}

CATOPTRIC_INLINE EightInts larger(const EightInts& a, const EightInts& b) {
  return a > b ? a : b;
}

template <class Vector>
CATOPTRIC_INLINE void swapWhere(const EightInts& which, Vector& a, Vector& b) {
  const Vector kept = a;
  a = which ? b : a;
  b = which ? kept : b;
}

/// To 1/256 px, to nearest: a float of this size has no room for less.
CATOPTRIC_INLINE EightInts toSubpixels(const Eight& pixels) {
  constexpr float kRounds = 12582912.0f;  // 1.5 * 2^23
  const Eight rounded = pixels * float(kSub) + kRounds, zero = Eight{} + kRounds;
  EightInts bits, zeroBits;
  std::memcpy(&bits, &rounded, sizeof bits);
  std::memcpy(&zeroBits, &zero, sizeof zeroBits);
  return bits - zeroBits;
}

struct Corners {
  EightInts x[3], y[3];
  Eight nearness[3];
};

/// Pixels whose centres may lie inside, first and last.
struct Boxes {
  EightInts x0, y0, x1, y1;
};

/// Step 1; corners of those that are hard become zero.
CATOPTRIC_INLINE Corners findCorners(const gl::Scissor& bounds, TriangleGroup& g, Boxes& box) {
  Corners c;
  EightInts near = core::fromBits(g.wanted);
  for (int k = 0; k < 3; ++k) {
    const Eight x = load(g.x[k]), y = load(g.y[k]), none{};
    const EightInts isInReach = (x > -TriangleGroup::kReach) & (x < TriangleGroup::kReach) &
                                (y > -TriangleGroup::kReach) & (y < TriangleGroup::kReach);  // not for a NaN
    near &= isInReach;
    c.x[k] = toSubpixels(isInReach ? x : none) - bounds.x * kSub;
    c.y[k] = toSubpixels(isInReach ? y : none) - bounds.y * kSub;
    c.nearness[k] = load(g.nearness[k]);
  }
  const EightInts left = smaller(smaller(c.x[0], c.x[1]), c.x[2]),
                  right = larger(larger(c.x[0], c.x[1]), c.x[2]),
                  low = smaller(smaller(c.y[0], c.y[1]), c.y[2]),
                  high = larger(larger(c.y[0], c.y[1]), c.y[2]);
  const EightInts zero{};
  box = {larger((left + (kSub / 2 - 1)) >> 8, zero), larger((low + (kSub / 2 - 1)) >> 8, zero),
         smaller((right - kSub / 2) >> 8, zero + (bounds.width - 1)),
         smaller((high - kSub / 2) >> 8, zero + (bounds.height - 1))};
  const EightInts seen = (box.x1 >= box.x0) & (box.y1 >= box.y0),
                  wide = larger(right - left, high - low) > TriangleGroup::kLargestPx * kSub;
  g.hard = g.wanted & toBits(~near | (seen & wide));
  const EightInts easy = near & seen & ~wide;
  for (int k = 0; k < 3; ++k) c.x[k] &= easy, c.y[k] &= easy;
  return c;
}

/// Step 2; those without an area, or a pixel, have a height of 0 and are not inside of their edges.
struct Edges {
  EightInts value[3], stepX[3], stepY[3];
};

CATOPTRIC_INLINE Edges findEdges(Corners& c, const Boxes& box, TriangleGroup& g) {
  EightInts area = (c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) - (c.x[2] - c.x[0]) * (c.y[1] - c.y[0]);
  const EightInts turned = area < 0;
  swapWhere(turned, c.x[1], c.x[2]), swapWhere(turned, c.y[1], c.y[2]);
  swapWhere(turned, c.nearness[1], c.nearness[2]);
  area = turned ? -area : area;
  const EightInts px = box.x0 * kSub + kSub / 2, py = box.y0 * kSub + kSub / 2;
  Edges edges;
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const EightInts dx = c.x[b] - c.x[a], dy = c.y[b] - c.y[a];
    edges.stepX[k] = -dy * kSub, edges.stepY[k] = dx * kSub;
    const EightInts owns = (dy < 0) | ((dy == 0) & (dx > 0));  // an edge's pixels belong to one side
    edges.value[k] = dx * (py - c.y[a]) - dy * (px - c.x[a]) + ~owns;
    store(g.edge[k], edges.value[k]), store(g.stepX[k], edges.stepX[k]), store(g.stepY[k], edges.stepY[k]);
  }
  const auto toFloats = [](const EightInts& v) __attribute__((always_inline)) {
    return __builtin_convertvector(v, Eight);
  };
  const Eight scale = float(kSub) / toFloats(area);
  const Eight toB = (c.nearness[1] - c.nearness[0]) * scale, toC = (c.nearness[2] - c.nearness[0]) * scale;
  const Eight nearX = toB * toFloats(c.y[2] - c.y[0]) - toC * toFloats(c.y[1] - c.y[0]);
  const Eight nearY = toC * toFloats(c.x[1] - c.x[0]) - toB * toFloats(c.x[2] - c.x[0]);
  store(g.near,
        c.nearness[0] + (toFloats(px - c.x[0]) * nearX + toFloats(py - c.y[0]) * nearY) / float(kSub));
  store(g.nearX, nearX), store(g.nearY, nearY);
  const Eight &n0 = c.nearness[0], &n1 = c.nearness[1], &n2 = c.nearness[2];
  const Eight least = n1 < n0 ? n1 : n0, most = n0 < n1 ? n1 : n0;
  store(g.least, n2 < least ? n2 : least), store(g.most, most < n2 ? n2 : most);
  const EightInts width = area > 0 ? box.x1 - box.x0 + 1 : EightInts{},
                  height = area > 0 ? box.y1 - box.y0 + 1 : EightInts{};
  store(g.x0, box.x0), store(g.y0, box.y0), store(g.width, width), store(g.height, height);
  const unsigned drawn = toBits(area > 0);
  g.tiny = drawn & toBits((width <= TriangleGroup::kTinyPx) & (height <= TriangleGroup::kTinyPx));
  g.small = drawn & ~g.tiny;
  return edges;
}

/// Step 3.
CATOPTRIC_INLINE void findInside(Edges& edges, TriangleGroup& g) {
  int width = 0, height = 0;
  for (int i = 0; i < TriangleGroup::kLanes; ++i)
    if ((g.tiny >> i & 1u) != 0) width = std::max(width, g.width[i]), height = std::max(height, g.height[i]);
  EightInts inside[2] = {};
  for (int j = 0; j < height; ++j) {
    EightInts e0 = edges.value[0], e1 = edges.value[1], e2 = edges.value[2], row{};
    for (int i = 0; i < width; ++i) {
      row |= ~((e0 | e1 | e2) >> 31) & (1 << i);
      e0 += edges.stepX[0], e1 += edges.stepX[1], e2 += edges.stepX[2];
    }
    inside[j / 4] |= row << (8 * (j % 4));
    for (int k = 0; k < 3; ++k) edges.value[k] += edges.stepY[k];
  }
  store(g.inside[0], inside[0]), store(g.inside[1], inside[1]);
}

struct SetUpTriangles {
  static CATOPTRIC_INLINE void run(const gl::Scissor& bounds, TriangleGroup& group) {
    Boxes box;
    Corners corners = findCorners(bounds, group, box);
    Edges edges = findEdges(corners, box, group);
    if (group.tiny != 0) findInside(edges, group);
  }
};

struct GatherCorners {
  static CATOPTRIC_INLINE void run(const std::span<const vec3>& screen,
                                   const std::uint32_t (&corners)[3][TriangleGroup::kLanes],
                                   TriangleGroup& group) {
    for (int k = 0; k < 3; ++k) {
      Eight columns[3];
      core::gatherTriples(&screen.data()->x, corners[k], 1, columns);
      store(group.x[k], columns[0]), store(group.y[k], columns[1]), store(group.nearness[k], columns[2]);
    }
  }
};

}  // namespace

void gatherCorners(std::span<const vec3> screen, const std::uint32_t (&corners)[3][TriangleGroup::kLanes],
                   TriangleGroup& group) {
  core::runOnWidestVectors<GatherCorners>(screen, corners, group);
}

void setUpTriangles(const gl::Scissor& bounds, TriangleGroup& group) {
  core::runOnWidestVectors<SetUpTriangles>(bounds, group);
}

}  // namespace catoptric::virtual_object
