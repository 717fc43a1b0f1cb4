// SPDX-License-Identifier: Apache-2.0
// The one table of solvers that are PointFinders.
#pragma once

#include <memory>

#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {

/// Nothing for Explosion and Refined, which need none, and where Analytic does not know the mirror's shape;
/// that is said once. `mesh` must outlive the finder.
[[nodiscard]] std::unique_ptr<PointFinder> makePointFinder(Solver solver, const scene::WorldGeometry& world,
                                                           std::uint32_t reflector, bool flipped,
                                                           const ReflectorMesh& mesh);

}  // namespace catoptric::virtual_object
