// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/hierarchy_triangles.h"

#include <cassert>

#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::scene {

std::vector<geometry::HierarchyTriangle> listTriangles(const WorldGeometry& world,
                                                       std::span<const std::uint32_t> flags) {
  assert(flags.size() == world.parts.size());
  std::vector<geometry::HierarchyTriangle> triangles;
  triangles.reserve(world.triangleCount());
  for (std::uint32_t t = 0; t < world.triangleCount(); ++t) {
    const std::uint32_t part = world.triangleParts[t];
    if (flags[part] == kLeftOut) continue;
    const std::uint32_t* v = &world.indices[3 * std::size_t(t)];
    triangles.push_back(
        {world.positions[v[0]], world.positions[v[1]], world.positions[v[2]], t, part, flags[part]});
  }
  return triangles;
}

std::vector<geometry::HierarchyTriangle> listTriangles(const WorldGeometry& world) {
  std::vector<std::uint32_t> flags;
  flags.reserve(world.parts.size());
  for (const Part& part : world.parts) flags.push_back(part.isSeenFromBehind ? geometry::kTwoSided : 0u);
  return listTriangles(world, flags);
}

}  // namespace catoptric::scene
