// SPDX-License-Identifier: Apache-2.0
// Two balls before a wall, z = 6, seen from the plane z = 0 and from behind it: closed forms to judge warps
// by.
#pragma once

#include <optional>
#include <vector>

#include "catoptric/depth_reflection_map/forward_warp.h"

namespace catoptric::depth_reflection_map {

struct Ball {
  dvec3 centre;
  double radius;
};

inline const std::vector<Ball>& balls() {
  static const std::vector<Ball> list{{{-0.3, 0.1, 2.5}, 0.5}, {{0.5, -0.2, 3.5}, 0.6}};
  return list;
}

/// Distance along a ray, in lengths of its direction, that must have z > 0.
inline double castRay(const dvec3& from, const dvec3& direction) {
  double best = (6.0 - from.z) / direction.z;
  for (const Ball& ball : balls()) {
    const dvec3 offset = from - ball.centre;
    const double a = glm::dot(direction, direction), b = glm::dot(direction, offset),
                 c = glm::dot(offset, offset) - ball.radius * ball.radius;
    const double root = b * b - a * c;
    if (root < 0) continue;
    const double t = (-b - std::sqrt(root)) / a;
    if (t > 0) best = std::min(best, t);
  }
  return best;
}

/// Looks along +z through the square of the plane z = 0 around the origin with the given half edge.
inline Pinhole lookThroughWindow(const dvec3& centre, double half, int pixels) {
  Pinhole view;
  view.centre = centre;
  view.worldFromPixel[0] = dvec3(2 * half / pixels, 0, 0);
  view.worldFromPixel[1] = dvec3(0, 2 * half / pixels, 0);
  view.worldFromPixel[2] = dvec3(-half, -half, 0) - centre;
  return view;
}

inline ZexelMap takeSyntheticMap(const Pinhole& reference, int size) {
  std::vector<float> disparities;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      disparities.push_back(
          float(1.0 / castRay(reference.centre, reference.worldFromPixel * dvec3(x + 0.5, y + 0.5, 1))));
  return makeZexelMap(size, size, disparities);
}

/// The world point of a winner.
inline dvec3 pointOfWinner(std::uint32_t winner, const ZexelMap& map, const Pinhole& reference) {
  const int index = int((winner & kWinnerIndexMask) - 1u), x = index % map.width, y = index / map.width;
  const double d = map.levels[0].disparities[std::size_t(index)];
  return reference.centre + reference.worldFromPixel * dvec3(x + 0.5, y + 0.5, 1) / d;
}

/// Pixels between where a view shows a point and a position.
inline double displacementPx(const Pinhole& view, const dvec3& point, double x, double y) {
  const dvec3 h = glm::inverse(view.worldFromPixel) * (point - view.centre);
  return glm::length(dvec2(h / h.z) - dvec2(x, y));
}

}  // namespace catoptric::depth_reflection_map
