// SPDX-License-Identifier: Apache-2.0
// Is this mesh the linear extrusion of a planar curve?
//
// Inputs: as shape_recognition.h. Steps:
//   1. axis: the direction that all normals are perpendicular to (smallest eigenvector of their covariance),
//   2. vertices and normals projected along it and welded: the points of the profile,
//   3. edges of the mesh, projected: between points that differ they must form one chain or one ring,
//   4. deviation: how far vertices lie from their profile point, and normals from its normal.
// Absent where the normals span no plane (a flat mesh), leave it (anything doubly curved), or where the edges
// branch. The profile stays a polyline with normals, as a mesh is one of triangles with normals. Known
// failure: vertices that do not lie above each other (a sheared tessellation) make a profile that doubles
// back, which is refused. Cost: linear in triangles, besides the welding.
#pragma once

#include <vector>

#include "catoptric/geometry/shape_recognition.h"

namespace catoptric::geometry {

struct ExtrusionFit {
  dvec3 origin{0};                              ///< on the axis direction through the mean of the vertices
  dvec3 x{1, 0, 0}, y{0, 1, 0}, axis{0, 0, 1};  ///< orthonormal, right-handed
  std::vector<dvec2> points;                    ///< of the profile, in order, its bright side to the left
  std::vector<dvec2> normals;                   ///< unit, towards the bright side
  bool isClosed = false;                        ///< a ring: the last point joins the first
  double low = 0, high = 0;                     ///< extent along the axis, from the origin
  FitDeviation deviation;

  [[nodiscard]] dvec2 project(const dvec3& p) const {
    return {glm::dot(p - origin, x), glm::dot(p - origin, y)};
  }
};

[[nodiscard]] std::optional<ExtrusionFit> fitExtrusion(const MeshView& mesh);

}  // namespace catoptric::geometry
