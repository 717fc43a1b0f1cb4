// SPDX-License-Identifier: Apache-2.0
// Nearest point of the triangles of a hierarchy: how far one surface is from another.
#pragma once

#include <cstdint>
#include <optional>

#include "catoptric/core/math.h"
#include "catoptric/geometry/triangle_hierarchy.h"

namespace catoptric::geometry {

struct NearestPoint {
  std::uint32_t triangle = 0;  ///< HierarchyTriangle::triangle
  double distance = 0;         ///< in units of the triangles
  double u = 0, v = 0;         ///< weights of corners b and c
};

/// Of the triangles of one part (HierarchyTriangle::part), nearer than `most`. Nothing if there is none; the
/// point must be finite.
[[nodiscard]] std::optional<NearestPoint> findNearestPoint(const TriangleHierarchy& hierarchy,
                                                           const dvec3& point, double most,
                                                           std::uint32_t part);

}  // namespace catoptric::geometry
