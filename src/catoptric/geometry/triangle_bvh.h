// SPDX-License-Identifier: Apache-2.0
// Nearest hit of a ray with a set of triangles: a bounding volume hierarchy for work that is done once, such
// as baking. Double at the ray, exact to rounding; not watertight at edges. The judge has Embree for speed;
// methods must not see the judge (docs/decisions.md).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

struct TriangleHit {
  std::uint32_t triangle = 0;
  double distance = 0;   ///< in lengths of the direction
  double u = 0, v = 0;   ///< weights of corners 1 and 2
  bool isFront = false;  ///< the ray meets the side from which the corners go counter-clockwise
};

class TriangleBvh {
 public:
  /// Three corners a triangle. `twoSided` holds one flag a triangle: others are hit on their front only.
  TriangleBvh(std::vector<vec3> corners, std::vector<std::uint8_t> twoSided);

  /// Nearest hit farther than `least`; `ignored` is a triangle that the ray starts on.
  [[nodiscard]] std::optional<TriangleHit> findNearest(const dvec3& origin, const dvec3& direction,
                                                       double least = 0,
                                                       std::uint32_t ignored = 0xffffffffu) const;
  [[nodiscard]] std::size_t triangleCount() const { return twoSided_.size(); }

 private:
  struct Node {
    vec3 lower, upper;
    std::uint32_t first = 0;  ///< leaf: into order_; else the left child, the right one follows it
    std::uint32_t count = 0;  ///< 0: inner node
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  [[nodiscard]] std::optional<TriangleHit> intersect(std::uint32_t triangle, const dvec3& origin,
                                                     const dvec3& direction) const;

  std::vector<vec3> corners_;
  std::vector<std::uint8_t> twoSided_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace catoptric::geometry
