// SPDX-License-Identifier: Apache-2.0
// The ray octree of a mirror's trace at the location nearest to the eye, as an eye elsewhere sees it: the
// cells that hold a point, from the root down, and the rays of the leaf; some of the map's other rays; the
// locations of the sampling cell.
#include <algorithm>

#include "catoptric/reflection_morphing/reflection_morphing_method.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr std::size_t kMostRays = 60;
const vec3 kLocationColor(0.2f, 0.5f, 1.0f), kCellColor(0.55f, 0.12f, 0.4f), kLeafColor(1.0f, 0.1f, 0.7f),
    kRayColor(0.3f, 0.5f, 0.1f), kLeafRayColor(1.0f, 0.9f, 0.1f), kPointColor(1.0f, 0.2f, 0.1f);

void addRay(const OctreeRay& ray, double length, const vec3& color, raster::Marks& marks) {
  marks.addLine(ray.origin, dvec3(ray.origin) + length * dvec3(ray.direction), color);
}

/// As RayOctree::findLeaf() goes.
void addLeaf(const SampledTrace& trace, const dvec3& location, const vec3& point, raster::Marks& marks) {
  const RayOctree& octree = trace.octree;
  if (octree.nodes.empty()) return;
  dvec3 low(octree.lower), half = 0.5 * (dvec3(octree.upper) - low);
  std::uint32_t node = 0;
  marks.addBox(low, low + 2.0 * half, kCellColor);
  while (octree.nodes[node].count == 0) {
    node = octree.nodes[node].first;
    for (int axis = 0; axis < 3; ++axis)
      if (double(point[axis]) >= low[axis] + half[axis]) {
        node += 1u << axis;
        low[axis] += half[axis];
      }
    half *= 0.5;
    marks.addBox(low, low + 2.0 * half, octree.nodes[node].count == 0 ? kCellColor : kLeafColor);
  }
  // Each ray of the leaf on its way: from the location over the mirror to where it passes the point.
  for (const std::uint32_t index : octree.findLeaf(point)) {
    const OctreeRay& ray = octree.rays[index];
    marks.addLine(location, ray.origin, kLeafRayColor);
    addRay(ray, glm::dot(dvec3(point) - dvec3(ray.origin), dvec3(ray.direction)) + 2.0 * half.x,
           kLeafRayColor, marks);
  }
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 arm(0);
    arm[axis] = 2.0 * half.x;
    marks.addLine(dvec3(point) - arm, dvec3(point) + arm, kPointColor);
  }
}

}  // namespace

void ReflectionMorphingMethod::collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                                            const raster::MarkOptions& options, raster::Marks& marks) const {
  if (!options.octree || !cell_) return;
  const double rayLength = 2.0 * world.bounds.radius();
  const dvec3 first = source_->grid().location(cell_->locations[0]);
  marks.addBox(first, source_->grid().location(cell_->locations[7]), kLocationColor);
  const auto heaviest = std::max_element(cell_->weights.begin(), cell_->weights.end());
  const SamplingLocation& location =
      *locations_.at(cell_->locations[std::size_t(heaviest - cell_->weights.begin())]);
  const SampledTrace* trace = location.findTrace({reflector});
  if (!trace) return;
  const std::vector<OctreeRay>& rays = trace->octree.rays;
  const std::size_t stride = std::max<std::size_t>(1, rays.size() / kMostRays);
  for (std::size_t i = 0; i < rays.size(); i += stride) {
    addRay(rays[i], rayLength, kRayColor, marks);
    marks.addLine(location.position, rays[i].origin, 0.4f * kLocationColor);
  }
  if (options.point) addLeaf(*trace, location.position, vec3(*options.point), marks);
}

}  // namespace catoptric::reflection_morphing
