// SPDX-License-Identifier: Apache-2.0
// Which way a mirror faces where a location sees something in it.
#pragma once

#include "catoptric/reflection_morphing/find_ray.h"

namespace catoptric::reflection_morphing {

/// Adds to `sum` the mirror's unit normal (world; towards the location) at each of kMostSearches places of
/// the chart. A mirror's normal bisects the angle between the ray that comes and the one that leaves, so that
/// the trace must be of one mirror.
void addNormals(const RayTable& table, const RayBatch::Floats& chartX, const RayBatch::Floats& chartY,
                std::array<RayBatch::Floats, 3>& sum);

}  // namespace catoptric::reflection_morphing
