// SPDX-License-Identifier: Apache-2.0
// Which ray of a table passes through a scene point (2004, section 6).
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "catoptric/reflection_morphing/ray_octree.h"
#include "catoptric/reflection_morphing/ray_table.h"

namespace catoptric::reflection_morphing {

inline constexpr std::size_t kMostSearches = 64;  ///< the texels of so many fit the nearest cache

/// Some of the searches of a batch, a bit each.
using SearchSet = std::uint64_t;

[[nodiscard]] inline SearchSet firstSearches(std::size_t count) {
  return count >= kMostSearches ? ~SearchSet(0) : (SearchSet(1) << count) - 1;
}

/// Calls visit(i) with every search of the set, in order.
template <class Visit>
void forEachSearch(SearchSet set, const Visit& visit) {
  for (; set != 0; set &= set - 1) visit(std::size_t(std::countr_zero(set)));
}

/// Up to kMostSearches searches; element i of each array belongs to search i.
struct alignas(32) RayBatch {
  using Floats = std::array<float, kMostSearches>;
  Floats point[3]{};   ///< world
  Floats x{}, y{};     ///< texels; where the search begins, then where it ended: another one may start there
  Floats mirror[3]{};  ///< the first mirror point, as seen from the location; world
  Floats rest{};       ///< from there over the other mirrors to the scene point
};

inline constexpr int kMostShortened = 2;  ///< what the way along a curved edge may need

/// Solves origin(p) + t direction(p) = point on the interpolated table for the searches of `which`, side by
/// side. They begin at places that are RayTable::isFilled(). Those that end inside are returned; the others
/// are not reflected. A step that leaves the map is shortened to its edge: `mostShortened` times, then the
/// search ends past it, which continues the map; 0: it ends at once, and where it is means nothing.
[[nodiscard]] SearchSet findRays(const RayTable& table, SearchSet which, int mostShortened, RayBatch& batch);

/// The searches of `which` that stand where the table is filled.
[[nodiscard]] SearchSet findFilled(const RayTable& table, SearchSet which, const RayBatch& batch);

/// Where a scene point is seen.
struct FoundRay {
  vec3 mirrorPoint{0};
  float rest = 0;
  bool isInside = false;
};

/// One search, from a ray of the octree.
[[nodiscard]] FoundRay findRay(const RayTable& table, const vec3& scenePoint, const vec2& texel);

}  // namespace catoptric::reflection_morphing
