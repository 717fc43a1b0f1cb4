// SPDX-License-Identifier: Apache-2.0
// The regular solids with flat facets: each facet has its own corners and one normal, so that it is a planar
// mirror.
#pragma once

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

enum class Polyhedron { Tetrahedron, Cube, Octahedron, Dodecahedron, Icosahedron };

/// Centred on the origin, corners at the given distance from it.
[[nodiscard]] Mesh makePolyhedron(Polyhedron kind, double circumradius);

/// Convex hull of a few points (at most about a hundred) with flat facets: every plane through three points
/// that has all others on one side becomes one facet. Cost grows with the fourth power of the number of
/// points.
[[nodiscard]] Mesh makeConvexHull(const std::vector<dvec3>& points);

}  // namespace catoptric::geometry
