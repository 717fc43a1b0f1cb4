// SPDX-License-Identifier: Apache-2.0
// A bounding-volume hierarchy over triangles, for single rays (nearest_hit.h) and for bundles of them (the
// exact solver). Built once per geometry; contiguous arrays. Independent of the ray tracer that judges
// (reference/), which methods must not see (docs/decisions.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

/// A triangle in the order of the hierarchy's leaves.
struct HierarchyTriangle {
  vec3 a{0}, b{0}, c{0};
  std::uint32_t triangle = 0;  ///< index into the span given
  std::uint32_t part = 0;
  std::uint32_t flags = 0;  ///< the caller's
};

class TriangleHierarchy {
 public:
  /// Triangles with a non-finite corner are left out.
  explicit TriangleHierarchy(std::span<const HierarchyTriangle> triangles);

  struct Node {
    vec3 lower{0}, upper{0};
    std::uint32_t first = 0;  ///< leaf: first triangle; inner: index of the second child, the first is next
    std::uint32_t count = 0;  ///< of triangles; 0 = inner node
  };
  /// nodes()[0] is the root; empty without triangles.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const HierarchyTriangle> triangles() const { return triangles_; }

 private:
  void build(std::uint32_t begin, std::uint32_t end, int depth);

  std::vector<HierarchyTriangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace catoptric::geometry
