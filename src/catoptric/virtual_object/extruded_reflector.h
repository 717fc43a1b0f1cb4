// SPDX-License-Identifier: Apache-2.0
// Reflection in the linear extrusion of a convex planar curve (Ofek & Rappoport 1998, section 5).
//
// Question: where does the eye E see the point Q? Seen along the axis everything is plane geometry, and along
// the axis the unfolded path is straight.
//   1. For each eye: at every front-facing point of the profile the reflected ray; at the first back-facing
//      point beyond on either side the view ray straight on (profile cells).
//   2. Cells between neighbouring rays, in an implicit hierarchy: C(i, j) is bounded by ray i, ray j and the
//      chord i-j. From the whole run halve until one segment is left, each time by three tests on which side
//      of a line Q lies (the region may reach around a chord's ends): O(log n).
//   3. Within the segment position and normal are linear, as on the mesh: one equation in one unknown, Q on
//      the reflected ray, solved within its bracket.
//   4. The height: E and Q divide the axis in the ratio of their distances across it.
//
// An open profile goes on past its ends with the curvature it has there (Blythe's rule), for doubly virtual
// vertices. Departures: the paper mirrors in the plane of a segment; step 3 interpolates normals. Profile
// cells on both sides close the region. Known failures: convex profiles only (a concave one has several J).
// Source: as above.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "catoptric/geometry/extrusion.h"
#include "catoptric/virtual_object/point_finder.h"

namespace catoptric::virtual_object {

class ExtrudedReflector {
 public:
  /// `profile` must be convex seen from its bright side. `skirt`: how far an open profile goes on, world
  /// units.
  ExtrudedReflector(const geometry::ExtrusionFit& profile, double skirt);

  void setEye(const dvec3& eye);
  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& point) const;

  /// Step 2: the segment of the profile whose cell holds the point (in the plane), found by halving and by
  /// asking every one.
  [[nodiscard]] std::optional<std::uint32_t> locate(const dvec2& point) const;
  [[nodiscard]] std::optional<std::uint32_t> locateByAll(const dvec2& point) const;

  [[nodiscard]] dvec2 project(const dvec3& point) const { return profile_.project(point); }

 private:
  void addSkirt(double width);
  [[nodiscard]] bool isInCell(std::uint32_t first, std::uint32_t last, const dvec2& point) const;
  [[nodiscard]] double solveWithin(std::uint32_t segment, const dvec2& point) const;

  geometry::ExtrusionFit profile_;
  std::size_t skirtPoints_ = 0;  ///< at either end
  dvec3 eye_{0};
  dvec2 eyeFlat_{0};
  /// Of the run of cells, in order along the profile.
  std::vector<dvec2> points_, normals_, rays_;
  std::vector<std::uint8_t> isSkirt_;  ///< of each segment of the run
};

}  // namespace catoptric::virtual_object
