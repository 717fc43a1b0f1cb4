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

double findSpacing(const scene::WorldGeometry& world, const core::Box& eyes, double maxErrorPx) {
  // The point of a ball's surface in which something is seen moves with the eye, and its second derivative
  // falls with the square of the distance: error_px = kErrorPx (spacing / distance)^2, fitted to the 95th
  // percentile that tests/unit/reflection_morphing prints. Nearer than its radius no eye is assumed. What a
  // lens shows is magnified, and so is its error.
  constexpr double kErrorPx = 33, kRefractorShare = 0.35;
  double nearest = 0;
  for (const scene::Reflector& r : world.reflectors) {
    if (r.isPlanarMirror() || !(r.radius > 0)) continue;
    const dvec3 closest = glm::clamp(r.centre, eyes.lower, eyes.upper);
    const double distance = std::max(glm::length(closest - r.centre), r.radius);
    const double reach = r.isRefractor() ? kRefractorShare * distance : distance;
    nearest = nearest == 0 ? reach : std::min(nearest, reach);
  }
  return nearest * std::sqrt(maxErrorPx / kErrorPx);
}

SamplingGrid makeGrid(const core::Box& box, double spacing, std::uint32_t mostCells) {
  SamplingGrid grid;
  grid.box = box;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = spacing > 0 ? std::ceil((box.upper[axis] - box.lower[axis]) / spacing - 1e-9) : 1.0;
    grid.counts[axis] = std::uint32_t(std::clamp(cells, 1.0, double(mostCells))) + 1;
  }
  return grid;
}

BakePlan makeDefaultPlan(const scene::WorldGeometry& world) {
  BakePlan plan;
  plan.options.octree.box = makeLookUpBox(world);
  const core::Box& box = plan.options.octree.box;
  plan.options.map.mapped = listMapped(world);
  plan.grid = makeGrid(box, findSpacing(world, box, kDefaultMaxErrorPx), kMostDefaultCells);
  return plan;
}

BakePlan makePlanAround(const scene::WorldGeometry& world, const dvec3& eye) {
  constexpr double kCells = 512;  // each way from the eye
  BakePlan plan;
  plan.options.octree.box = makeLookUpBox(world);
  plan.options.map.mapped = listMapped(world);
  double spacing = findSpacing(world, {eye, eye}, kDefaultMaxErrorPx);
  if (!(spacing > 0)) spacing = std::max(world.bounds.radius(), 1e-6);
  spacing =
      std::exp2(std::floor(std::log2(spacing)));  // so that an eye that moves a little has the same grid
  const dvec3 middle = glm::round(eye / (64 * spacing)) * (64 * spacing);
  plan.grid.box = {middle - kCells * spacing, middle + kCells * spacing};
  plan.grid.counts = glm::uvec3(std::uint32_t(2 * kCells) + 1);
  return plan;
}

}  // namespace catoptric::reflection_morphing
