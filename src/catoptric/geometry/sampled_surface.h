// SPDX-License-Identifier: Apache-2.0
// Surfaces given by formulas, sampled with exact normals: one vertex for each point, no texture coordinates,
// as smooth mirrors need them. Of any curvature; for convex ones see convex_edges.h.
#pragma once

#include <functional>

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

struct HeightSample {
  double z = 0, dzdx = 0, dzdy = 0;
};

/// The graph z = height(x, y), front towards +z, over the image of a grid of cells: `place` maps (s, t) in
/// [-1, 1]^2 to (x, y), keeping its orientation.
[[nodiscard]] Mesh makeHeightField(int cellsX, int cellsY, const std::function<dvec2(dvec2)>& place,
                                   const std::function<HeightSample(dvec2)>& height);

struct RadiusSample {
  double radius = 0, slope = 0;  ///< slope: d radius / d y
};

/// The side of a solid of revolution around y, 0 <= y <= height, front outwards; radii above zero.
[[nodiscard]] Mesh makeRevolvedSide(double height, int segmentsAround, int rows,
                                    const std::function<RadiusSample(double y)>& radius);

}  // namespace catoptric::geometry
