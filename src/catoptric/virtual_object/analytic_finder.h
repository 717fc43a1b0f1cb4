// SPDX-License-Identifier: Apache-2.0
// Solver `analytic`: the reflection point of a mirror whose shape is known, on the shape itself instead of
// its mesh (Ofek & Rappoport 1998, section 5). special_reflector.h and extruded_reflector.h do the
// mathematics, and for implicit surfaces implicit_reflector.h searches.
#pragma once

#include <memory>
#include <string>

#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/point_finder.h"

namespace catoptric::virtual_object {

/// Why the solver cannot serve a mirror; empty where it can: spheres, cylinders, cones, other quadrics, tori
/// and aspheric mirrors, seen from either side, and extrusions of convex curves.
[[nodiscard]] std::string findAnalyticObstacle(const scene::Reflector& reflector, bool flipped = false);

/// Refits the shape to the mirror's vertices. Nothing where there is an obstacle. `skirt`: how far an open
/// mirror is continued, world units.
[[nodiscard]] std::unique_ptr<PointFinder> makeAnalyticFinder(const scene::WorldGeometry& world,
                                                              std::uint32_t reflector, bool flipped,
                                                              double skirt);

}  // namespace catoptric::virtual_object
