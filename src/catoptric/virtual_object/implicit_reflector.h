// SPDX-License-Identifier: Apache-2.0
// Where does the eye E see the point Q in a surface given by an equation f = 0? Found by search (Ofek &
// Rappoport 1998, section 5: implicit surfaces).
//
// World space, double. J is where the path |EJ| + |JQ| is stationary on f = 0 (Fermat):
//   1. Once: seeds on the surface, spread over the mirror by place and by normal, each with the nearest ones.
//   2. A pair E, Q: at every seed the part of the path's gradient across the normal, times
//      |EJ||QJ|/(|EJ|+|QJ|) (reflection_point.h says why); searches start at seeds where it is smaller than
//      at all their neighbours but two.
//   3. Newton in the tangent plane, with the Hessian of the path less that of f times the multiplier
//      (G.n)/|grad f|, back onto the surface after each step, shortened where it does not help.
//   4. What obeys the law, with E and Q on the bright side, and was not found before, is a reflection.
//   5. Near a caustic two or three reflections lie within one seed's cell, in a row along the direction in
//      which the path hardly bends. So from where a search ends, found or stuck, the derivative is taken to
//      both sides along that valley; a cubic through it says where others are.
//   6. Between two minima lies a saddle, whose basin may hold no seed: where the path bends alike at two
//      reflections, a search starts between them.
// Any geometry/implicit_surface.h will do: quadrics, tori and aspheric mirrors are recognised and fitted.
//
// Departures: Hanrahan & Mitchell 1992 bracket roots with interval arithmetic; here seeds stand for
// intervals, and steps 5 and 6 for their subdivision. Known failures: double roots (Q on a caustic); one in
// 3,000 where E or Q is near the inside of a tube. Cost: 30 to 150 us. Sources: Mitchell &
// Hanrahan 1992; Chen & Arvo 2000 for the Hessian.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/geometry/implicit_surface.h"
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

  /// `isTurned`: bright where the gradient does not point to. `points`: on the mirror, as many as there are
  /// (its vertices). `radius`: of the mirror's bounding sphere.
  ImplicitReflector(std::shared_ptr<const geometry::ImplicitSurface> surface, bool isTurned,
                    std::span<const vec3> points, double radius, std::size_t fewestSeeds = kSeeds);

  /// All that searches from the mirror lead to, on the whole sheet, past its boundary as well.
  [[nodiscard]] ImplicitReflections findReflections(const dvec3& eye, const dvec3& point) const;

  /// The one that the best seed leads to, or nothing: several times faster, for mirrors of which a point has
  /// one reflection.
  [[nodiscard]] std::optional<Reflection> findFromBestSeed(const dvec3& eye, const dvec3& point) const;

 private:
  struct State;
  struct Tangent;
  [[nodiscard]] double measureSquared(const Reflection& a, const Reflection& b) const;
  void spreadSeeds(std::span<const vec3> points, std::size_t fewest);
  void findNeighbours();
  [[nodiscard]] State evaluate(const dvec3& at, const dvec3& normal, const dvec3& eye,
                               const dvec3& point) const;
  [[nodiscard]] State evaluateOn(const dvec3& near, const dvec3& eye, const dvec3& point) const;
  [[nodiscard]] Tangent differentiate(const State& state) const;
  [[nodiscard]] dvec3 mirrorAtFoot(const dvec3& near, const dvec3& far) const;
  State descend(const dvec3& near, const dvec3& eye, const dvec3& point) const;
  bool add(const State& state, ImplicitReflections& found) const;
  void search(const dvec3& near, const dvec3& eye, const dvec3& point, ImplicitReflections& found,
              int lookingAround) const;
  void lookAlongValley(const State& state, const dvec3& eye, const dvec3& point, ImplicitReflections& found,
                       int lookingAround) const;
  void lookBetween(const Reflection& a, const Reflection& b, const dvec3& eye, const dvec3& point,
                   ImplicitReflections& found) const;

  std::shared_ptr<const geometry::ImplicitSurface> surface_;
  double side_;  ///< -1: turned
  double radius_;
  double spacing_ = 0;  ///< of seeds, by measureSquared
  std::vector<Reflection> seeds_;
  std::vector<std::array<std::uint16_t, kNeighbours>> neighbours_;
};

}  // namespace catoptric::virtual_object
