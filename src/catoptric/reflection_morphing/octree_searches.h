// SPDX-License-Identifier: Apache-2.0
// Searches that begin at rays of the octree.
#pragma once

#include "catoptric/reflection_morphing/find_ray.h"
#include "catoptric/reflection_morphing/sampling_location.h"

namespace catoptric::reflection_morphing {

enum class OctreeSearch : std::uint8_t { FromNearest, FromNearestAndInnermost };

/// Searches for the points of `which` from the rays of the leaves in which they lie, and returns those that
/// end inside, as findRays() does.
[[nodiscard]] SearchSet searchFromOctree(const SampledTrace& trace, SearchSet which, OctreeSearch search,
                                         RayBatch& batch);

}  // namespace catoptric::reflection_morphing
