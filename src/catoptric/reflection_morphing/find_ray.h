// SPDX-License-Identifier: Apache-2.0
// Which ray of a table passes through a scene point (2004, section 6).
#pragma once

#include <array>
#include <span>

#include "catoptric/reflection_morphing/ray_octree.h"
#include "catoptric/reflection_morphing/ray_table.h"

namespace catoptric::reflection_morphing {

inline constexpr std::size_t kMostSearches = 64;  ///< the texels of so many fit the nearest cache

/// Up to kMostSearches searches; element i of each array belongs to search i.
struct RayBatch {
  using Floats = std::array<float, kMostSearches>;
  Floats point[3];   ///< world
  Floats x, y;       ///< texels; where the search begins, then where it ended: another one may start there
  Floats mirror[3];  ///< the first mirror point, as seen from the location; world
  Floats rest;       ///< from there over the other mirrors to the scene point
  std::array<std::uint8_t, kMostSearches> isInside;  ///< 0: continued past the edge, it is not reflected
};

/// Solves origin(p) + t direction(p) = point on the interpolated table for the searches that `which` lists,
/// side by side. They begin at places that are RayTable::isFilled().
void findRays(const RayTable& table, std::span<const std::uint8_t> which, RayBatch& batch);

/// Where a scene point is seen.
struct FoundRay {
  vec3 mirrorPoint{0};
  float rest = 0;
  bool isInside = false;
};

/// One search, from a ray of the octree.
[[nodiscard]] FoundRay findRay(const RayTable& table, const vec3& scenePoint, const vec2& texel);

}  // namespace catoptric::reflection_morphing
