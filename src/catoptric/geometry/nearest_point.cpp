// SPDX-License-Identifier: Apache-2.0
// Boxes that are farther than the nearest point so far are left out; the nearer of two is looked at first.
#include "catoptric/geometry/nearest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kDeepest = 128;  // of the stack; the hierarchy's builder bounds its depth

double squaredDistanceToBox(const TriangleHierarchy::Node& node, const dvec3& point) {
  const dvec3 outside = glm::max(glm::max(dvec3(node.lower) - point, point - dvec3(node.upper)), dvec3(0));
  return glm::dot(outside, outside);
}

/// Weights of b and c of the triangle's point that is nearest to `point` (Ericson 2005, section 5.1.5).
dvec2 findNearestWeights(const dvec3& point, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - along, along};
  }
  const double sum = va + vb + vc;
  return sum > 0 ? dvec2(vb, vc) / sum : dvec2(0, 0);  // without an area: a corner
}

}  // namespace

std::optional<NearestPoint> findNearestPoint(const TriangleHierarchy& hierarchy, const dvec3& point,
                                             double most, std::uint32_t part) {
  const auto nodes = hierarchy.nodes();
  std::optional<NearestPoint> nearest;
  if (nodes.empty()) return nearest;
  double best = most * most;
  std::array<std::pair<std::uint32_t, double>, kDeepest> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, squaredDistanceToBox(nodes[0], point)};
  while (depth > 0) {
    const auto [at, toBox] = stack[--depth];
    if (!(toBox < best)) continue;
    const TriangleHierarchy::Node& node = nodes[at];
    if (node.count == 0) {
      std::pair nearer{at + 1, squaredDistanceToBox(nodes[at + 1], point)};
      std::pair farther{node.first, squaredDistanceToBox(nodes[node.first], point)};
      if (farther.second < nearer.second) std::swap(nearer, farther);
      stack[depth++] = farther;
      stack[depth++] = nearer;
      continue;
    }
    for (const HierarchyTriangle& t : hierarchy.triangles().subspan(node.first, node.count)) {
      if (t.part != part) continue;
      const dvec3 a(t.a), b(t.b), c(t.c);
      const dvec2 w = findNearestWeights(point, a, b, c);
      const dvec3 offset = point - (a + w.x * (b - a) + w.y * (c - a));
      const double squared = glm::dot(offset, offset);
      if (!(squared < best)) continue;
      best = squared;
      nearest = {t.triangle, std::sqrt(squared), w.x, w.y};
    }
  }
  return nearest;
}

}  // namespace catoptric::geometry
