// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/location_source.h"

#include <algorithm>
#include <cmath>

namespace catoptric::reflection_morphing {

core::Box makeLookUpBox(const scene::WorldGeometry& world) {
  core::Box box = world.bounds.isEmpty() ? core::Box{dvec3(-1), dvec3(1)} : world.bounds;
  const double margin = 1e-3 * std::max(box.radius(), 1e-6);
  return {box.lower - margin, box.upper + margin};
}

BakePlan makeDefaultPlan(const scene::WorldGeometry& world) {
  constexpr double kMostCells = 64, kCellsPerRadius = 5;
  BakePlan plan;
  plan.options.octree.box = makeLookUpBox(world);
  double smallest = 0;
  for (const scene::Reflector& r : world.reflectors)
    if (r.shape != scene::ReflectorShape::Plane && r.radius > 0)
      smallest = smallest == 0 ? r.radius : std::min(smallest, r.radius);
  plan.grid.box = plan.options.octree.box;
  const dvec3 size = plan.grid.box.upper - plan.grid.box.lower;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = smallest > 0 ? std::ceil(kCellsPerRadius * size[axis] / smallest) : 1.0;
    plan.grid.counts[axis] = std::uint32_t(std::clamp(cells, 1.0, kMostCells)) + 1;
  }
  return plan;
}

}  // namespace catoptric::reflection_morphing
