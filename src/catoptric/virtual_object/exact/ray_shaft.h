// SPDX-License-Identifier: Apache-2.0
// A conservative bound of a bundle of rays: what can any of them meet?
//
// In:  rays (world; origin, unit direction) of a tile of mirror pixels, and how far the scene reaches.
// Out: a shaft in a frame (u, v, w) whose w is the mean direction, and tests of boxes and triangles against
// it. Steps:
//   1. Every ray is x(h) = x(0) + s h in its height h along w. The largest x of all rays is a convex
//      function of h, so a straight line from its value at h = 0 to that at the far end bounds it from
//      above, exactly at both ends, for rays that diverge, converge or cross. Four such planes and a near
//      plane make the shaft.
//   2. A box is out if it lies beyond one of the five planes.
//   3. A triangle is out if its corners do, or if one of its edges passes on the wrong side of all rays: in
//      offsets from the ray at the corners' own heights, the side is the 2-D cross product of A' and B' -
//      A', taken as intervals.
//   4. If all three sides are certain, the triangle covers the whole bundle; what is behind it cannot be
//      seen.
// Departures: methods.md asks for a bounding shaft only; 3 and 4 are what makes large tiles affordable.
// Known failure: directions more than about 70 degrees from their mean have no shaft; split the bundle.
// Cost: about 10 ns a ray, 10 to 60 ns a triangle.
// Source: shafts after Haines & Wallace 1991.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

/// `origins[i]`, `directions[i]`: one ray; the fourth components are ignored.
struct RaySpan {
  std::span<const vec4> origins, directions;
};

/// Heights along the shaft between which a triangle may be met; `coversAll`: every ray meets it, and from
/// outside.
struct ShaftHit {
  double nearest = 0, furthest = 0;
  bool coversAll = false;
};

class RayShaft {
 public:
  /// Nothing if there is no ray or if they spread too far. `reach`: no point of the scene is farther from an
  /// origin.
  [[nodiscard]] static std::optional<RayShaft> find(const RaySpan& rays, double reach);

  /// Height above the shaft's foot by which all rays have begun; what is met at a height h is farther than
  /// h - latestStart() from the ray's origin.
  [[nodiscard]] double latestStart() const { return latestStart_; }
  /// By how much the shaft widens to one side, along u or v, over its height.
  [[nodiscard]] double spread() const { return std::max(slope_.half.x, slope_.half.y); }
  /// May a ray meet the box?
  [[nodiscard]] bool mayMeet(const vec3& lower, const vec3& upper) const;
  /// The height of the box's nearest corner, or infinity if no ray may meet the box.
  [[nodiscard]] double findNearest(const vec3& lower, const vec3& upper) const;
  /// May a ray meet the triangle, at its front only if `singleSided`?
  [[nodiscard]] std::optional<ShaftHit> mayMeet(const vec3& a, const vec3& b, const vec3& c,
                                                bool singleSided) const;

 private:
  /// Where rays are at some height.
  struct Extent {
    dvec2 centre, half;
  };
  struct Frame {
    dvec3 u, v, w;
  };
  RayShaft() = default;
  void makePlanes();
  [[nodiscard]] Extent extentAt(double height) const;
  [[nodiscard]] dvec3 toFrame(const vec3& point) const;

  dvec3 centre_{0};  ///< world, at height 0
  Frame frame_{};
  Extent start_{}, end_{}, slope_{};
  double length_ = 1;              ///< height of end_
  double latestStart_ = 0;         ///< height at which all rays have begun
  std::array<dvec3, 5> planes_{};  ///< outside if dot(plane, point - centre) > limit
  std::array<double, 5> limits_{};
};

}  // namespace catoptric::virtual_object
