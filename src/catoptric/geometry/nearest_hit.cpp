// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/nearest_hit.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kDeepest = 128;  // of the stack; the hierarchy's builder bounds its depth
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// Where the ray enters the box, or infinity.
double enterBox(const vec3& lower, const vec3& upper, const dvec3& origin, const dvec3& inverse, double least,
                double most) {
  for (int axis = 0; axis < 3; ++axis) {
    double a = (double(lower[axis]) - origin[axis]) * inverse[axis];
    double b = (double(upper[axis]) - origin[axis]) * inverse[axis];
    if (a > b) std::swap(a, b);
    // A ray in the plane of a side gives NaN, which these comparisons leave out of account.
    if (a > least) least = a;
    if (b < most) most = b;
  }
  return least <= most ? least : kMiss;
}

/// Moeller & Trumbore 1997.
std::optional<TriangleHit> intersect(const HierarchyTriangle& t, const dvec3& origin,
                                     const dvec3& direction) {
  const dvec3 a(t.a), e1 = dvec3(t.b) - a, e2 = dvec3(t.c) - a;
  const dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  const bool isFront = determinant > 0;
  if (determinant == 0 || (!isFront && (t.flags & kTwoSided) == 0)) return std::nullopt;
  const dvec3 s = origin - a;
  const double u = glm::dot(s, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(direction, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return TriangleHit{t.triangle, glm::dot(e2, q) / determinant, u, v, isFront};
}

}  // namespace

std::optional<TriangleHit> findNearestHit(const TriangleHierarchy& hierarchy, const dvec3& origin,
                                          const dvec3& direction, double least, std::uint32_t ignored,
                                          std::uint32_t ignoredPart) {
  const auto nodes = hierarchy.nodes();
  std::optional<TriangleHit> nearest;
  if (nodes.empty()) return nearest;
  double most = kMiss;
  const dvec3 inverse = 1.0 / direction;
  const auto enter = [&](std::uint32_t node) {
    return enterBox(nodes[node].lower, nodes[node].upper, origin, inverse, least, most);
  };
  std::array<std::uint32_t, kDeepest> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const TriangleHierarchy::Node& node = nodes[at];
    if (!(enter(at) <= most)) continue;
    if (node.count == 0) {
      std::uint32_t nearer = at + 1, farther = node.first;
      double tNearer = enter(nearer), tFarther = enter(farther);
      if (tFarther < tNearer) std::swap(nearer, farther), std::swap(tNearer, tFarther);
      if (tFarther < kMiss) stack[depth++] = farther;
      if (tNearer < kMiss) stack[depth++] = nearer;  // pushed last, so looked at first
      continue;
    }
    for (const HierarchyTriangle& t : hierarchy.triangles().subspan(node.first, node.count)) {
      if (t.triangle == ignored || t.part == ignoredPart) continue;
      const auto hit = intersect(t, origin, direction);
      if (!hit || hit->distance <= least || hit->distance >= most) continue;
      nearest = hit;
      most = hit->distance;
    }
  }
  return nearest;
}

}  // namespace catoptric::geometry
