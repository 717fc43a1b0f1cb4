// SPDX-License-Identifier: Apache-2.0
// Surfaces made by moving a curve: extrusion of a polygon, lathe, loft through closed rings.
#pragma once

#include <span>

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

/// Solid between z = -depth/2 and +depth/2 whose outline is the simple polygon, counter-clockwise in the xy
/// plane, any shape. Sides whose neighbours bend by less than the crease angle are smooth. Texture in metres:
/// u along the outline (or x), v down (or -y).
[[nodiscard]] Mesh makeExtrusion(std::span<const dvec2> outline, double depth,
                                 double creaseAngleRadians = 0.0);

/// Solid of revolution around y. The profile runs from bottom to top as (radius, height), outside to its
/// right; radius 0 closes it at a pole. Texture: u around, v by height.
[[nodiscard]] Mesh makeLathe(std::span<const dvec2> profile, int segmentsAround,
                             double creaseAngleRadians = 0.6);

/// Surface through closed rings of equally many points each, counter-clockwise seen from where the rings go
/// to; no caps. Normals are smooth up to the crease angle.
[[nodiscard]] Mesh makeLoft(std::span<const std::vector<dvec3>> rings, double creaseAngleRadians);

/// Triangles of a simple polygon, counter-clockwise, by cutting ears: three indices each.
[[nodiscard]] std::vector<std::uint32_t> triangulate(std::span<const dvec2> outline);

}  // namespace catoptric::geometry
