// SPDX-License-Identifier: Apache-2.0
// A ray against one triangle of the world: for what the mouse points at, once an event.
#pragma once

#include <cmath>
#include <optional>

#include "catoptric/scene/world_geometry.h"

namespace catoptric::viewer {

struct TriangleHit {
  double distance = 0;  ///< in lengths of the direction
  double u = 0, v = 0;  ///< weights of the second and third corner
  bool isFront = false;
};

/// Möller and Trumbore 1997. `firstIndex`: of the triangle's corners in WorldGeometry::indices.
[[nodiscard]] inline std::optional<TriangleHit> hitTriangle(const scene::WorldGeometry& world,
                                                            std::size_t firstIndex, const dvec3& eye,
                                                            const dvec3& direction) {
  const auto corner = [&](std::size_t k) { return dvec3(world.positions[world.indices[firstIndex + k]]); };
  const dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
  const dvec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (std::abs(determinant) < 1e-30) return std::nullopt;
  const dvec3 q = glm::cross(eye - a, ab);
  const double u = glm::dot(eye - a, p) / determinant, v = glm::dot(direction, q) / determinant;
  const double distance = glm::dot(ac, q) / determinant;
  if (u < 0 || v < 0 || u + v > 1 || distance <= 0) return std::nullopt;
  return TriangleHit{distance, u, v, determinant > 0};
}

}  // namespace catoptric::viewer
