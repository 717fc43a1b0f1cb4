// SPDX-License-Identifier: Apache-2.0
// Nearest hit of a ray with the triangles of a hierarchy, for work that is done once, such as baking. Double
// at the ray, exact to rounding; not watertight at edges.
#pragma once

#include <cstdint>
#include <optional>

#include "catoptric/core/math.h"
#include "catoptric/geometry/triangle_hierarchy.h"

namespace catoptric::geometry {

struct TriangleHit {
  std::uint32_t triangle = 0;  ///< HierarchyTriangle::triangle
  double distance = 0;         ///< in lengths of the direction
  double u = 0, v = 0;         ///< weights of corners b and c
  bool isFront = false;        ///< the ray meets the side from which the corners go counter-clockwise
};

/// In HierarchyTriangle::flags: hit on both sides. Others are hit on their front only.
inline constexpr std::uint32_t kTwoSided = 1;

/// Nearest hit farther than `least`; `ignored` is a triangle that the ray starts on, `ignoredPart` a part
/// (HierarchyTriangle::part) that is not there for it.
[[nodiscard]] std::optional<TriangleHit> findNearestHit(const TriangleHierarchy& hierarchy,
                                                        const dvec3& origin, const dvec3& direction,
                                                        double least = 0, std::uint32_t ignored = 0xffffffffu,
                                                        std::uint32_t ignoredPart = 0xffffffffu);

}  // namespace catoptric::geometry
