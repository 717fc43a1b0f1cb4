// SPDX-License-Identifier: Apache-2.0
// Which ray of a map passes through a scene point (2004, section 6).
#pragma once

#include <span>

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {

/// Where a scene point is seen.
struct FoundRay {
  vec3 mirrorPoint{0};    ///< the first mirror point, as seen from the location
  float rest = 0;         ///< from there over the other mirrors to the scene point
  bool isInside = false;  ///< false: continued past the edge of the trace, the point is not reflected
  vec2 texel{0};          ///< where in the map the search ended; another one may start there
};

/// A search: for the ray through `point`, from the place `texel`, which must be RayMap::isFilled().
struct RayQuery {
  vec3 point{0};  ///< world
  vec2 texel{0};
  std::uint32_t answer = 0;  ///< which element of `found` gets the result
};

/// Solves origin(p) + t direction(p) = point on the interpolated map, for all queries, many at a time.
void findRays(const RayMap& map, std::span<const RayQuery> queries, std::span<FoundRay> found);

/// One search, from the texel `seed`, which must be the lower corner of a cell.
[[nodiscard]] FoundRay findRay(const RayMap& map, const vec3& scenePoint, std::uint32_t seed);

}  // namespace catoptric::reflection_morphing
