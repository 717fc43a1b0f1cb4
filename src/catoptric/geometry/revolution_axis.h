// SPDX-License-Identifier: Apache-2.0
// Around which axis is this surface of revolution turned?
//
// Inputs: as shape_recognition.h. Every normal line of such a surface meets the axis. Steps:
//   1. in Pluecker coordinates "two lines meet" is linear: d.(p x n) + m.n = 0 for an axis (d, m) and a
//      vertex p with normal n; m eliminated, d is the eigenvector of the smallest eigenvalue of a 3 x 3
//      matrix,
//   2. beside it the line through the vertices' mean along the mean normal: the better start where a shallow
//      cap has normals computed from facets,
//   3. an axis that the normals miss is none: a free-form mesh is told at once.
// Known failures: a sphere has many axes, a plane and a cylinder have families of them, one of which is
// returned; none where the normals do not differ. Cost: linear in vertices. Source: Pottmann & Randrup 1998.
#pragma once

#include <vector>

#include "catoptric/geometry/shape_recognition.h"

namespace catoptric::geometry {

/// Columns x, y, axis of an orthonormal right-handed frame and a point on the axis near the vertices.
struct AxisFrame {
  dvec3 origin{0};
  dmat3 axes{1.0};

  [[nodiscard]] dvec3 toLocal(const dvec3& p) const { return (p - origin) * axes; }
  /// The frame turned by small angles around its own x and y and moved along its own axes.
  [[nodiscard]] AxisFrame moved(const dvec2& turn, const dvec3& move) const;
};

/// The axis points to where the normals do, on the whole.
[[nodiscard]] std::vector<AxisFrame> findRevolutionAxes(const MeshView& mesh);

/// Centre of the vertices and the root of their mean squared distance from it.
struct MeshScale {
  dvec3 centre{0};
  double size = 0;
};
[[nodiscard]] MeshScale measureScale(const MeshView& mesh);

}  // namespace catoptric::geometry
