// SPDX-License-Identifier: Apache-2.0
// Where does the eye E see the point Q in a surface given by an equation f = 0? Found by search (Ofek &
// Rappoport 1998, section 5: implicit surfaces).
//
// World space, double. J is where the path |EJ| + |JQ| is stationary on f = 0 (Fermat):
//   1. Once: seeds on the surface, spread over the mirror, each with its nearest others.
//   2. A pair E, Q: at every seed the part of the path's gradient across the normal, times
//   |EJ||QJ|/(|EJ|+|QJ|)
//      (reflection_point.h says why); searches start at seeds where it is smaller than at all their
//      neighbours.
//   3. Newton in the tangent plane, with the Hessian of the path less that of f times the multiplier
//      (G.n)/|grad f|, back onto the surface after each step, shortened where it does not help.
//   4. What obeys the law, with E and Q on the bright side, and was not found before, is a reflection.
// Any surface with a gradient and a Hessian would do; quadrics are what is recognised and fitted
// (geometry/quadric.h).
//
// Departures: Hanrahan & Mitchell 1992 bracket roots with interval arithmetic; here seeds stand for
// intervals, so that two roots within a seed's cell may be taken for one. Known failures: double roots (Q on
// a caustic). Cost: 5 to 15 us. Sources: Mitchell & Hanrahan 1992; Chen & Arvo 2000 for the Hessian.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/virtual_object/special_reflector.h"

namespace catoptric::virtual_object {

struct ImplicitReflections {
  static constexpr int kMost = 16;
  std::array<Reflection, kMost> all;
  int count = 0;

  [[nodiscard]] const Reflection* begin() const { return all.data(); }
  [[nodiscard]] const Reflection* end() const { return all.data() + count; }
};

class ImplicitReflector {
 public:
  static constexpr std::size_t kSeeds = 240, kNeighbours = 8;

  /// The gradient points to the bright side. `points`: on the mirror, as many as there are (its vertices).
  /// `radius`: of the mirror's bounding sphere.
  ImplicitReflector(const geometry::Quadric& surface, std::span<const vec3> points, double radius,
                    std::size_t seeds = kSeeds);

  /// All that searches from the mirror lead to, on the whole surface, past its boundary as well.
  [[nodiscard]] ImplicitReflections findReflections(const dvec3& eye, const dvec3& point) const;

 private:
  struct State;
  [[nodiscard]] State evaluate(const dvec3& at, const dvec3& eye, const dvec3& point) const;
  [[nodiscard]] dvec3 mirrorAtFoot(const dvec3& near, const dvec3& far) const;
  [[nodiscard]] dvec3 findStep(const State& state) const;
  void search(dvec3 at, const dvec3& eye, const dvec3& point, ImplicitReflections& found) const;

  geometry::Quadric surface_;
  dmat3 hessian_;
  double radius_;
  std::vector<dvec3> seeds_;
  std::vector<std::array<std::uint16_t, kNeighbours>> neighbours_;
};

}  // namespace catoptric::virtual_object
