// SPDX-License-Identifier: Apache-2.0
// The reflection subdivision of a triangle mesh for one eye (Ofek & Rappoport 1998, section 3), as a
// structure of its own: in which cells of space does a point lie?
//
//   Reflected cell of a triangle: what it sweeps when its corners V travel along their reflected rays,
//   V + t R. Its sides are the ruled bilinear surfaces s (Vi + t Ri) + (1 - s) (Vj + t Rj). Triangles with
//   at least one front-facing corner have one; back-facing corners send the view ray straight on (profile
//   triangles with their normals fixed up).
//   Hidden cell: the infinite pyramid behind it, away from the eye.
//   Unreflected region: everything else. On a closed mirror it is empty but for slivers; past the boundary
//   of an open one the skirt's cells fill it as far as the skirt goes, which takes the place of the paper's
//   bisecting surfaces.
//
// Point location, exact:
//   1. Candidates from a hierarchy of balls and cones over the cells.
//   2. Q lies in the plane of the travelling triangle where det[Vi + t Ri - Q] = 0, a cubic in t; for each
//      root t >= 0 its barycentrics there say whether Q is inside. The cubic counts both sides of a fold, so
//      in concave mirrors a point may have several cells, and twice the same one.
//
// Departures: the paper stops at the cell and mirrors in planes interpolated by these barycentrics;
// SubdivisionFinder goes on by Newton from there, since interpolated rays are not the rays of interpolated
// normals (the difference is of second order in the triangle's size). Cost: 10 to 15 us per point; building
// is n log n.
#pragma once

#include <vector>

#include "catoptric/virtual_object/point_finder.h"
#include "catoptric/virtual_object/ray_cone_tree.h"

namespace catoptric::virtual_object {

struct CellPoint {
  SurfacePoint at;
  double travel = 0;  ///< t, world units: how far along the rays; for a hidden cell, beyond the mirror
};

class ReflectionSubdivision {
 public:
  /// Of skirt triangles, too. `mesh` must outlive the subdivision.
  void build(const ReflectorMesh& mesh, const dvec3& eye, const ReflectedRays& rays);

  /// All reflected cells that hold the point, nearest first. `found` is cleared.
  void findReflectedCells(const dvec3& point, std::vector<CellPoint>& found) const;
  /// The same by asking every cell; for tests.
  void findReflectedCellsByAll(const dvec3& point, std::vector<CellPoint>& found) const;
  /// The nearest of them.
  [[nodiscard]] std::optional<CellPoint> findReflectedCell(const dvec3& point) const;

  /// The hidden cell that holds the point: of the triangle nearest to the eye. Skirt left out.
  [[nodiscard]] std::optional<CellPoint> findHiddenCell(const dvec3& point) const;

 private:
  template <class Add>
  void testCell(std::uint32_t triangle, const dvec3& point, const Add& add) const;

  const ReflectorMesh* mesh_ = nullptr;
  dvec3 eye_{0};
  std::vector<dvec3> rays_;                ///< three per triangle
  std::vector<std::uint32_t> reflecting_;  ///< triangles with a reflected cell
  RayConeTree reflected_, hidden_;
};

/// Solver `subdivision`: cell, then Newton from its barycentrics.
class SubdivisionFinder : public PointFinder {
 public:
  explicit SubdivisionFinder(const ReflectorMesh& mesh) : mesh_(&mesh) {}
  void setEye(const EyeView& view) override;
  [[nodiscard]] bool knowsHiddenPoints() const override { return true; }
  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& scenePoint) const override;
  [[nodiscard]] const ReflectionSubdivision& subdivision() const { return subdivision_; }

 private:
  const ReflectorMesh* mesh_;
  dvec3 eye_{0};
  ReflectionSubdivision subdivision_;
};

}  // namespace catoptric::virtual_object
