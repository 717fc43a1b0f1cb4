// SPDX-License-Identifier: Apache-2.0
// Size and convexity of a triangle mesh, distance to a triangle.
#pragma once

#include <span>

#include "catoptric/core/math.h"
#include "catoptric/geometry/shape_recognition.h"

namespace catoptric::geometry {

struct BoundingSphere {
  dvec3 centre{0};
  double radius = 0;
};

/// Holds every point; a few per cent larger than the smallest one at most (Ritter 1990, then steps of Badoiu
/// & Clarkson 2003 towards the farthest point). Deterministic.
[[nodiscard]] BoundingSphere computeBoundingSphere(std::span<const vec3> points);

/// From a point to the nearest point of a triangle, also of one that is a line or a point (Ericson 2005,
/// section 5.1.5).
[[nodiscard]] double computeDistanceToTriangle(const dvec3& point, const dvec3& a, const dvec3& b,
                                               const dvec3& c);

[[nodiscard]] double computeArea(const MeshView& mesh);

/// Is the surface convex seen from its front, to within tessellation, so that no ray that leaves its front
/// side can meet it again? Locally: across every edge the neighbour's far vertex is not in front of the
/// triangle's plane. Globally: no vertex is in front of the planes of a spread sample of triangles (locally
/// convex but wound up, or too gently concave per edge). "In front" means by an angle of more than 1e-3
/// radians plus half of what the vertex normals spread over the distance: a smooth convex surface stays
/// convex when its quads are cut along the wrong diagonals. Edges with more than two triangles or with two
/// triangles of opposite winding make the surface not convex; borders are allowed.
[[nodiscard]] bool isConvexMesh(const MeshView& mesh);

}  // namespace catoptric::geometry
