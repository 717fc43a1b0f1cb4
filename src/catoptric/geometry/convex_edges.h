// SPDX-License-Identifier: Apache-2.0
// Which of the two diagonals? A smooth convex surface sampled on a grid is a convex mesh only if every quad
// is cut along the diagonal that bends outwards, and where cells are sheared even the grid's own edges may
// have to give way.
#pragma once

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

/// Flips edges between two triangles wherever the far corner of one lies in front of the plane of the other,
/// until none is left or flips stop helping (Lawson 1977, with the lifted surface itself in place of the
/// paraboloid). Vertices, normals and the outline stay. For surface patches that are graphs over a plane,
/// vertices shared; bends below float precision are left alone.
[[nodiscard]] Mesh withConvexEdges(Mesh mesh);

}  // namespace catoptric::geometry
