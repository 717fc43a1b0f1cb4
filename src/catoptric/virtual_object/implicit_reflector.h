// SPDX-License-Identifier: Apache-2.0
// Where does the eye E see the point Q in a mirror given by an equation f = 0? Everywhere on it that it does
// (Ofek & Rappoport 1998, section 5: implicit surfaces).
//
// World space, double. J is where the path |EJ| + |JQ| is stationary on f = 0 (Fermat):
//   1. Once: patches that cover the mirror (monge_patches.h), and seeds on it, spread by place and by normal.
//   2. A pair E, Q: where on the mirror a reflection may be, all of them, each alone (root_isolation.h).
//   3. Newton in the tangent plane, with the Hessian of the path less that of f times the multiplier
//      (G.n)/|grad f|, back onto the surface after each step, shortened where it does not help.
//   4. What obeys the law, with E and Q on the bright side, and was not found before, is a reflection.
//   5. Where the mirror has none, the surface past its boundary may: at every seed the part of the path's
//      gradient across the normal, times |EJ||QJ|/(|EJ|+|QJ|) (reflection_point.h says why); step 3 starts at
//      seeds where it is smaller than at all their neighbours.
// Any geometry/implicit_surface.h will do: quadrics, tori and aspheric mirrors are recognised and fitted.
//
// Departures: Mitchell & Hanrahan 1992 bracket roots with interval arithmetic; here bounds of derivatives do.
// Known failures: double roots (Q on a caustic); past the boundary not all are found. Cost: 15 to 60 us on a
// shallow mirror, 50 to 300 us on an ellipsoid or a torus; 5 to 35 ms once.
// Sources: Mitchell & Hanrahan 1992; Chen & Arvo 2000 for the Hessian.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/geometry/implicit_surface.h"
#include "catoptric/virtual_object/monge_patches.h"
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

  /// `isTurned`: bright where the gradient does not point to. `mesh`: the mirror, vertices near f = 0.
  /// `radius`: of its bounding sphere.
  ImplicitReflector(std::shared_ptr<const geometry::ImplicitSurface> surface, bool isTurned,
                    const geometry::MeshView& mesh, double radius);

  /// All on the mirror; where there are none, those that searches past its boundary lead to.
  [[nodiscard]] ImplicitReflections findReflections(const dvec3& eye, const dvec3& point) const;

 private:
  struct State;
  struct Tangent;
  [[nodiscard]] double measureSquared(const Reflection& a, const Reflection& b) const;
  void spreadSeeds(std::span<const vec3> points);
  void findNeighbours();
  [[nodiscard]] State evaluate(const dvec3& at, const dvec3& normal, const dvec3& eye,
                               const dvec3& point) const;
  [[nodiscard]] State evaluateOn(const dvec3& near, const dvec3& eye, const dvec3& point) const;
  [[nodiscard]] Tangent differentiate(const State& state) const;
  [[nodiscard]] State descend(const dvec3& near, const dvec3& eye, const dvec3& point) const;
  void add(const State& state, ImplicitReflections& found) const;
  void searchPastBoundary(const dvec3& eye, const dvec3& point, ImplicitReflections& found) const;

  std::shared_ptr<const geometry::ImplicitSurface> surface_;
  double side_;  ///< -1: turned
  double radius_;
  std::vector<Reflection> seeds_;
  MongePatches patches_;
  std::vector<std::array<std::uint16_t, kNeighbours>> neighbours_;
};

}  // namespace catoptric::virtual_object
