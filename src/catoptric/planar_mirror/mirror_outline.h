// SPDX-License-Identifier: Apache-2.0
// Clip planes through the eye and the edges of a polygonal mirror (2005, section 17.1.2).
#pragma once

#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/raster/reflection_method.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::planar_mirror {

/// Corners of a flat mirror whose triangles together are one convex polygon, in order, world; empty where
/// they are not, or where it has more than `mostCorners`. Corners on a straight edge are left out.
[[nodiscard]] std::vector<dvec3> findConvexOutline(const scene::WorldGeometry& world, std::uint32_t reflector,
                                                   std::size_t mostCorners);

/// A plane for each edge through the eye of `view`, moved outwards by one pixel, so that none of the mirror's
/// pixels is lost to rounding; dot(xyz, p) + w >= 0 is inside.
[[nodiscard]] std::vector<vec4> makeEdgePlanes(std::span<const dvec3> outline,
                                               const raster::PinholeView& view);

/// Is there a pixel between the planes that shows another mirror? What is drawn there would get into it.
[[nodiscard]] bool coverOtherMirror(std::span<const vec4> edgePlanes, const raster::PinholeView& view,
                                    const raster::Chain& chain, std::span<const uvec2> parentIds,
                                    int widthPx);

}  // namespace catoptric::planar_mirror
