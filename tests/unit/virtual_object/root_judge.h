// SPDX-License-Identifier: Apache-2.0
// Every point of a surface where the path eye - surface - point is stationary, found without any of the
// solvers' mathematics: the judge of whether they miss one.
//
// In:  a surface or a curve by its parameters; E and Q (same frame).
// Steps:
//   1. The derivatives of the path along both parameters, at the nodes and middles of a grid.
//   2. A cell may hold a root where each derivative's range over its five samples, widened by half its width
//      to both sides, has 0 in it. Such a cell is cut into four and asked again, kDepth times. So is any
//      that is longer than E or Q is far from its middle, up to kNearDepth times: the derivatives turn in it.
//   3. What is left: Newton by differences from its middle and its corners, once each.
// On a curve: the same with one parameter; roots by halving.
// Known failure: two roots nearer than about 1/1000 of the patch; E or Q within some 1e-5 of it
// (9 of 3.8 million inside a torus).
// Cost: 0.04 to 0.4 ms a pair.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

/// A point and unit tangents along the parameters, not parallel.
struct PatchPoint {
  dvec3 at{0}, alongU{0}, alongV{0};
};

/// Numbers side by side, for a loop over all.
struct GridPoints {
  std::array<std::vector<double>, 3> at, alongU, alongV;

  void add(const PatchPoint& p);
};

class SurfacePatch {
 public:
  using Place = std::function<PatchPoint(const dvec2& uv)>;
  SurfacePatch(Place place, const dvec2& lower, const dvec2& upper, int cellsU, int cellsV);

  [[nodiscard]] std::vector<dvec3> findStationary(const dvec3& eye, const dvec3& point) const;

 private:
  struct Cell;
  struct Query;
  [[nodiscard]] PatchPoint placeAt(int x, int y) const;
  [[nodiscard]] bool isNear(const Cell& cell) const;
  void ask(Query& query, const Cell& cell) const;
  void polish(Query& query, dvec2 uv) const;

  Place place_;
  dvec2 lower_, upper_;
  dvec2 step_;  ///< of the finest grid: half a cell that is cut kNearDepth times
  int cellsU_, cellsV_;
  double diagonal_ = 0;           ///< the longest one of a cell
  std::vector<PatchPoint> kept_;  ///< row by row, of a grid between those
  GridPoints nodes_, middles_;
};

/// Where a function of an angle is zero, over the whole turn.
[[nodiscard]] std::vector<double> findAngles(const std::function<double(double radians)>& function);

}  // namespace catoptric::virtual_object
