// SPDX-License-Identifier: Apache-2.0
// Split at the median of the centres along the longest axis; leaves of four triangles.
#include "catoptric/geometry/triangle_bvh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <numeric>

namespace catoptric::geometry {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr int kDeepest = 64;  // of the stack; the median halves, so 32 bits of triangles need 32

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
  return least <= most ? least : std::numeric_limits<double>::infinity();
}

}  // namespace

TriangleBvh::TriangleBvh(std::vector<vec3> corners, std::vector<std::uint8_t> twoSided)
    : corners_(std::move(corners)), twoSided_(std::move(twoSided)), order_(twoSided_.size()) {
  assert(corners_.size() == 3 * twoSided_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (order_.empty()) return;
  nodes_.reserve(2 * order_.size());
  nodes_.emplace_back();
  split(0, 0, std::uint32_t(order_.size()));
}

void TriangleBvh::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  core::Box bounds, centres;
  const auto centreOf = [&](std::uint32_t t) {
    return dvec3(corners_[3 * t] + corners_[3 * t + 1] + corners_[3 * t + 2]);
  };
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) bounds.add(dvec3(corners_[3 * order_[i] + k]));
    centres.add(centreOf(order_[i]));
  }
  nodes_[node].lower = vec3(bounds.lower);
  nodes_[node].upper = vec3(bounds.upper);
  if (count <= kLeafTriangles) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  const dvec3 size = centres.upper - centres.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = centreOf(a)[axis], y = centreOf(b)[axis];
                     return x != y ? x < y : a < b;
                   });
  const auto left = std::uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = left;
  split(left, first, half);
  split(left + 1, first + half, count - half);
}

std::optional<TriangleHit> TriangleBvh::intersect(std::uint32_t triangle, const dvec3& origin,
                                                  const dvec3& direction) const {
  // Moeller & Trumbore 1997.
  const dvec3 a(corners_[3 * triangle]);
  const dvec3 e1 = dvec3(corners_[3 * triangle + 1]) - a, e2 = dvec3(corners_[3 * triangle + 2]) - a;
  const dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  const bool isFront = determinant > 0;
  if (determinant == 0 || (!isFront && twoSided_[triangle] == 0)) return std::nullopt;
  const dvec3 s = origin - a;
  const double u = glm::dot(s, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(direction, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return TriangleHit{triangle, glm::dot(e2, q) / determinant, u, v, isFront};
}

std::optional<TriangleHit> TriangleBvh::findNearest(const dvec3& origin, const dvec3& direction, double least,
                                                    std::uint32_t ignored) const {
  std::optional<TriangleHit> nearest;
  if (nodes_.empty()) return nearest;
  double most = std::numeric_limits<double>::infinity();
  const dvec3 inverse = 1.0 / direction;
  std::array<std::uint32_t, kDeepest> stack{};
  int depth = 0;
  stack[std::size_t(depth++)] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[std::size_t(--depth)]];
    if (!(enterBox(node.lower, node.upper, origin, inverse, least, most) <= most)) continue;
    if (node.count == 0) {
      const Node &l = nodes_[node.first], &r = nodes_[node.first + 1];
      const double tl = enterBox(l.lower, l.upper, origin, inverse, least, most);
      const double tr = enterBox(r.lower, r.upper, origin, inverse, least, most);
      constexpr double kMiss = std::numeric_limits<double>::infinity();
      const std::uint32_t nearer = tl <= tr ? 0 : 1;  // pushed last, so looked at first
      if (std::max(tl, tr) < kMiss) stack[std::size_t(depth++)] = node.first + 1 - nearer;
      if (std::min(tl, tr) < kMiss) stack[std::size_t(depth++)] = node.first + nearer;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (order_[i] == ignored) continue;
      const auto hit = intersect(order_[i], origin, direction);
      if (!hit || hit->distance <= least || hit->distance >= most) continue;
      nearest = hit;
      most = hit->distance;
    }
  }
  return nearest;
}

}  // namespace catoptric::geometry
