// SPDX-License-Identifier: Apache-2.0
// Steps: 1 bounds of the triangles and of their centres, 2 the cheapest of 16 planes by the surface area
// heuristic along the longest axis of the centres (Wald 2007), the middle where that finds none, 3 the same
// for both halves.
#include "catoptric/geometry/triangle_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace catoptric::geometry {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr int kBins = 16;
constexpr int kMaxDepth = 60;  // deeper halves are split in the middle: traversal stacks are bounded

struct Bounds {
  vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
  void add(const vec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  void add(const Bounds& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
  [[nodiscard]] float area() const {
    if (!(lower.x <= upper.x)) return 0.0f;
    const vec3 e = upper - lower;
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

Bounds boundsOf(const HierarchyTriangle& t) {
  Bounds bounds;
  for (const vec3* p : {&t.a, &t.b, &t.c}) bounds.add(*p);
  return bounds;
}

bool isFinite(const HierarchyTriangle& t) {
  for (const vec3* p : {&t.a, &t.b, &t.c})
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite((*p)[k])) return false;
  return true;
}

int binOf(float centre, float lower, float scale) {
  return std::clamp(int((centre - lower) * scale), 0, kBins - 1);
}

/// Number of bins that go into the first half; 0 if no plane separates anything.
int findSplit(std::span<const HierarchyTriangle> triangles, int axis, float lower, float scale) {
  std::array<Bounds, kBins> bounds;
  std::array<std::uint32_t, kBins> counts{};
  for (const HierarchyTriangle& t : triangles) {
    const int bin = binOf((t.a[axis] + t.b[axis] + t.c[axis]) / 3.0f, lower, scale);
    bounds[std::size_t(bin)].add(boundsOf(t));
    ++counts[std::size_t(bin)];
  }
  std::array<float, kBins> costRight{};
  Bounds right;
  std::uint32_t countRight = 0;
  for (int i = kBins - 1; i > 0; --i) {
    right.add(bounds[std::size_t(i)]);
    countRight += counts[std::size_t(i)];
    costRight[std::size_t(i)] = right.area() * float(countRight);
  }
  int best = 0;
  float bestCost = std::numeric_limits<float>::infinity();
  Bounds left;
  std::uint32_t countLeft = 0;
  for (int i = 1; i < kBins; ++i) {
    left.add(bounds[std::size_t(i) - 1]);
    countLeft += counts[std::size_t(i) - 1];
    if (countLeft == 0 || countLeft == triangles.size()) continue;
    const float cost = left.area() * float(countLeft) + costRight[std::size_t(i)];
    if (cost < bestCost) {
      bestCost = cost;
      best = i;
    }
  }
  return best;
}

}  // namespace

TriangleHierarchy::TriangleHierarchy(std::span<const HierarchyTriangle> triangles) {
  triangles_.reserve(triangles.size());
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(triangles_), isFinite);
  nodes_.reserve(triangles_.size());
  if (!triangles_.empty()) build(0, std::uint32_t(triangles_.size()), 0);
}

void TriangleHierarchy::build(std::uint32_t begin, std::uint32_t end, int depth) {
  // 1
  Bounds bounds, centres;
  for (std::uint32_t i = begin; i < end; ++i) {
    const HierarchyTriangle& t = triangles_[i];
    bounds.add(boundsOf(t));
    centres.add((t.a + t.b + t.c) / 3.0f);
  }
  const std::size_t node = nodes_.size();
  nodes_.push_back({bounds.lower, bounds.upper, begin, end - begin});
  if (end - begin <= kLeafTriangles) return;
  // 2
  const vec3 extent = centres.upper - centres.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto first = triangles_.begin() + begin, last = triangles_.begin() + end;
  const auto centre = [axis](const HierarchyTriangle& t) { return t.a[axis] + t.b[axis] + t.c[axis]; };
  auto middle = first + (end - begin) / 2;
  const float scale = float(kBins) / extent[axis], lower = centres.lower[axis];
  const int split =
      depth < kMaxDepth && std::isfinite(scale) ? findSplit({first, last}, axis, lower, scale) : 0;
  if (split > 0)
    middle = std::partition(first, last, [&](const HierarchyTriangle& t) {
      return binOf(centre(t) / 3.0f, lower, scale) < split;
    });
  else
    std::nth_element(first, middle, last, [&](const HierarchyTriangle& s, const HierarchyTriangle& t) {
      return centre(s) < centre(t);
    });
  // 3
  const auto half = std::uint32_t(middle - triangles_.begin());
  nodes_[node].count = 0;
  build(begin, half, depth + 1);
  nodes_[node].first = std::uint32_t(nodes_.size());
  build(half, end, depth + 1);
}

}  // namespace catoptric::geometry
