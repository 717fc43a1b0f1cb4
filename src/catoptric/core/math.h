// SPDX-License-Identifier: Apache-2.0
// The small mathematics every folder shares, on GLM. Angles are radians, world space is unmarked.
#pragma once

#include <cmath>
#include <optional>

#ifndef GLM_FORCE_RADIANS
#define GLM_FORCE_RADIANS
#endif
#ifndef GLM_ENABLE_EXPERIMENTAL
#define GLM_ENABLE_EXPERIMENTAL
#endif
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace catoptric {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

namespace core {

/// Oriented plane: points p with dot(normal, p) + offset = 0; the normal is unit and points to the mirror's
/// bright side.
struct Plane {
  dvec3 normal{0, 0, 1};
  double offset = 0;

  [[nodiscard]] double signedDistance(const dvec3& point) const { return glm::dot(normal, point) + offset; }
};

/// Mirror image of a point in a plane.
[[nodiscard]] inline dvec3 reflectPoint(const dvec3& point, const Plane& plane) {
  return point - 2.0 * plane.signedDistance(point) * plane.normal;
}

/// Mirror image of a direction for a unit normal (the mirror law; either side, like GLSL's reflect).
[[nodiscard]] inline dvec3 reflectDirection(const dvec3& direction, const dvec3& unitNormal) {
  return direction - 2.0 * glm::dot(direction, unitNormal) * unitNormal;
}

/// Direction behind a surface by Snell's law, like GLSL's refract: `eta` is the index of refraction on the
/// side that the light comes from over that on the other side; the unit normal points to the former. Nothing
/// where reflection is total.
[[nodiscard]] inline std::optional<dvec3> findRefractedDirection(const dvec3& direction,
                                                                 const dvec3& unitNormal, double eta) {
  const double along = glm::dot(direction, unitNormal);
  const double square = 1.0 - eta * eta * (1.0 - along * along);
  if (square < 0.0) return std::nullopt;
  return eta * direction - (eta * along + std::sqrt(square)) * unitNormal;
}

/// The 4x4 matrix of reflectPoint (McReynolds & Blythe 2005, section 17.1.2; Goldman 1990).
[[nodiscard]] inline dmat4 makeReflectionMatrix(const Plane& plane) {
  const dvec3 n = plane.normal;
  dmat4 m(1.0);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) m[column][row] -= 2.0 * n[row] * n[column];
  m[3] = dvec4(-2.0 * plane.offset * n, 1.0);
  return m;
}

/// Axis-aligned box; empty until something is added.
struct Box {
  dvec3 lower{1e300, 1e300, 1e300};
  dvec3 upper{-1e300, -1e300, -1e300};

  void add(const dvec3& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  void add(const Box& box) {
    lower = glm::min(lower, box.lower);
    upper = glm::max(upper, box.upper);
  }
  [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
  [[nodiscard]] dvec3 centre() const { return 0.5 * (lower + upper); }
  [[nodiscard]] double radius() const { return isEmpty() ? 0.0 : 0.5 * glm::length(upper - lower); }
};

}  // namespace core
}  // namespace catoptric
