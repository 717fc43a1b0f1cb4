// SPDX-License-Identifier: Apache-2.0
// The ray octree of one trace at one location (2004, section 4.2): which rays of the map pass near a point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {

struct RayOctreeOptions {
  core::Box box;  ///< the space in which scene points are looked up; points outside count as on its edge
  int depth = 5;  ///< levels below the root
  int mostLeafRays = 12;  ///< a leaf at the last level keeps that many, evenly chosen
};

/// A ray of the map that the octree may name.
struct OctreeRay {
  vec3 origin{0};
  float x = 0;  ///< its texel
  vec3 direction{0};
  float y = 0;
};

/// Linearised: eight children of a node follow each other. Every leaf holds at least one ray.
struct RayOctree {
  struct Node {
    std::uint32_t first = 0;  ///< inner node: its first child; leaf: into leafRays
    std::uint32_t count = 0;  ///< rays of the leaf; 0: inner node
  };
  vec3 lower{0}, upper{1};
  std::vector<Node> nodes;
  std::vector<std::uint32_t> leafRays;  ///< into rays
  std::vector<OctreeRay> rays;

  /// The rays (leafRays) of the leaf in which the point lies.
  [[nodiscard]] std::span<const std::uint32_t> findLeaf(const vec3& point) const;
};

struct RayOctreeStatistics {
  std::size_t leaves = 0, rays = 0, mostRays = 0;
};

/// `map` must be continued. Empty when the map has no cell to interpolate in.
[[nodiscard]] RayOctree makeRayOctree(const RayMap& map, const RayOctreeOptions& options);
[[nodiscard]] RayOctreeStatistics measure(const RayOctree& octree);

/// The ray of `leaf` that passes nearest to the point.
[[nodiscard]] const OctreeRay& findNearestRay(const RayOctree& octree, std::span<const std::uint32_t> leaf,
                                              const vec3& point);

/// The ray of the octree at a texel.
[[nodiscard]] OctreeRay makeOctreeRay(const RayMap& map, std::uint32_t texel);

}  // namespace catoptric::reflection_morphing
