// SPDX-License-Identifier: Apache-2.0
// How a ray changes from one pixel to the next, carried through hits and mirrors (Igehy 1999, Tracing Ray
// Differentials, equations 10 to 18). World space; directions are unit.
#pragma once

#include <algorithm>
#include <cmath>

#include "catoptric/core/math.h"
#include "catoptric/scene/camera_frame.h"

namespace catoptric::reference {

/// Derivatives with respect to the pixel's x (to the right) and y (downwards). Not initialised: this is hot.
template <class T>
struct PerPixel {
  T dx, dy;
};

struct RayDifferential {
  PerPixel<dvec3> origin, direction;
};

/// Longest derivative that is kept: grazing rays go to infinity, and infinities breed NaN.
inline constexpr double kLargestDerivative = 1e12;

[[nodiscard]] inline dvec3 limitDerivative(const dvec3& d) {
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (largest <= kLargestDerivative) return d;
  return largest < 1e300 ? d * (kLargestDerivative / largest) : dvec3(kLargestDerivative, 0, 0);
}

/// Equation 8: derivative of the unit direction of an unnormalised ray direction with derivative `change`.
[[nodiscard]] inline dvec3 differentiateNormalized(const dvec3& unit, double inverseLength,
                                                   const dvec3& change) {
  return (change - unit * glm::dot(unit, change)) * inverseLength;
}

/// Equation 10: change of the hit point at distance t on a plane; `inverseAcross` is 1 / dot(direction,
/// normal), where the normal need not be unit.
[[nodiscard]] inline dvec3 transferToPlane(const dvec3& originChange, const dvec3& directionChange,
                                           const dvec3& direction, double t, const dvec3& normal,
                                           double inverseAcross) {
  const dvec3 moved = originChange + t * directionChange;
  return limitDerivative(moved - direction * (glm::dot(moved, normal) * inverseAcross));
}

/// Equation 15: change of the mirrored direction when direction and unit normal change.
[[nodiscard]] inline dvec3 reflectDerivative(const dvec3& direction, const dvec3& directionChange,
                                             const dvec3& normal, const dvec3& normalChange) {
  const double along = glm::dot(direction, normal);
  const double alongChange = glm::dot(directionChange, normal) + glm::dot(direction, normalChange);
  return limitDerivative(directionChange - 2.0 * (along * normalChange + alongChange * normal));
}

/// Equations 16 to 18: change of the refracted direction (core::findRefractedDirection(), which must not be
/// totally reflected) when direction and unit normal change.
[[nodiscard]] inline dvec3 refractDerivative(const dvec3& direction, const dvec3& directionChange,
                                             const dvec3& normal, const dvec3& normalChange, double eta) {
  const double along = glm::dot(direction, normal);
  const double behind = std::sqrt(std::max(1.0 - eta * eta * (1.0 - along * along), 0.0));
  const double alongChange = glm::dot(directionChange, normal) + glm::dot(direction, normalChange);
  const double mu = eta * along + behind;
  const double muChange = eta * alongChange * (1.0 + eta * along / std::max(behind, 1e-12));
  return limitDerivative(eta * directionChange - (mu * normalChange + muChange * normal));
}

}  // namespace catoptric::reference
