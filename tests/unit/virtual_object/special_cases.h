// SPDX-License-Identifier: Apache-2.0
// Shapes with closed forms, and pairs of eye and point to try them with.
#pragma once

#include <ostream>
#include <random>

#include "catoptric/virtual_object/special_reflector.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {

struct Side {
  SpecialShape shape;
  bool isInside;
};

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest asks for this name.
inline void PrintTo(const Side& side, std::ostream* out) {
  constexpr const char* kNames[] = {"plane", "sphere", "cylinder", "cone"};
  *out << kNames[int(side.shape)] << (side.isInside ? " inside" : " outside");
}

inline SpecialReflector makeShape(const Side& side) {
  const dvec3 origin(0.3, -0.2, 0.5), axis = glm::normalize(dvec3(0.4, 1, -0.3));
  return {side.shape, origin, axis, 0.7, 0.45, side.isInside};
}

inline dvec3 randomPoint(std::mt19937& random, const dvec3& around) {
  std::uniform_real_distribution<double> uniform(0, 1);
  return around + randomDirection(random) * (0.05 + 6 * uniform(random) * uniform(random));
}

/// The sine of the angle between the half vector and the normal.
inline double sineAt(const Reflection& r, const dvec3& eye, const dvec3& point) {
  const dvec3 half = glm::normalize(eye - r.position) + glm::normalize(point - r.position);
  return glm::length(glm::cross(glm::normalize(half), r.normal));
}

}  // namespace catoptric::virtual_object
