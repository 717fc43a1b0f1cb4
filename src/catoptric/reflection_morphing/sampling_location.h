// SPDX-License-Identifier: Apache-2.0
// All that is baked at one sampling location, and its bytes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "catoptric/reflection_morphing/ray_map.h"
#include "catoptric/reflection_morphing/ray_octree.h"
#include "catoptric/reflection_morphing/ray_shaft.h"
#include "catoptric/reflection_morphing/ray_table.h"

namespace catoptric::reflection_morphing {

struct BakeOptions {
  RayMapOptions map;
  RayOctreeOptions octree;
};

/// One trace at one location.
struct SampledTrace {
  RayTable table;
  RayOctree octree;
  RayShaft shaft;
};

struct SamplingLocation {
  dvec3 position{0};
  std::vector<SampledTrace> traces;  ///< sorted by trace; none where no mirror is seen

  [[nodiscard]] const SampledTrace* findTrace(const Trace& trace) const;
};

/// Traces the maps and builds the octrees; returns their bytes, which depend on nothing but the arguments.
[[nodiscard]] std::vector<std::byte> bakeLocation(const MirrorRays& rays, const dvec3& position,
                                                  const BakeOptions& options);

/// From the bytes of bakeLocation(). Throws core::Error("bake.damaged") if they make no sense; every index
/// and size is checked, so that no bytes at all can do harm.
[[nodiscard]] std::shared_ptr<const SamplingLocation> unpackLocation(std::span<const std::byte> bytes,
                                                                     const core::Box& box);

}  // namespace catoptric::reflection_morphing
