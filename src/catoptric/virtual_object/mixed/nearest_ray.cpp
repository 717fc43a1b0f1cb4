// SPDX-License-Identifier: Apache-2.0
// Step 2 of interval_search.h, eight rays side by side.
#include <algorithm>
#include <limits>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/virtual_object/mixed/interval_search.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::load;

struct FindStarts {
  using RayGroup = IntervalSearch::RayGroup;
  using Start = IntervalSearch::Start;

  CATOPTRIC_INLINE static void run(const std::span<const RayGroup>& groups, const vec3& point,
                                   std::array<Start, kIntervals>& starts) {
    Eight best[kIntervals];
    EightInts bestGroup[kIntervals];
    for (std::size_t k = 0; k < kIntervals; ++k)
      best[k] = Eight{} + std::numeric_limits<float>::max(), bestGroup[k] = EightInts{};
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const RayGroup& rays = groups[g];
      Eight away[3], a[3], b[3];
      Eight t{};
      for (int k = 0; k < 3; ++k) {
        away[k] = point[k] - load(rays.origin[k]);
        t += away[k] * load(rays.direction[k]);
      }
      for (int k = 0; k < 3; ++k) {
        away[k] -= t * load(rays.direction[k]);
        a[k] = load(rays.originU[k]) + t * load(rays.directionU[k]);
        b[k] = load(rays.originV[k]) + t * load(rays.directionV[k]);
      }
      const Eight aa = core::dot(a, a), ab = core::dot(a, b), bb = core::dot(b, b), ad = core::dot(a, away),
                  bd = core::dot(b, away);
      const Eight inverse = 1.0f / (aa * bb - ab * ab + 1e-30f);
      const Eight u = (bb * ad - ab * bd) * inverse, v = (aa * bd - ab * ad) * inverse;
      Eight squared{};
      for (int k = 0; k < 3; ++k) {
        const Eight move = u * load(rays.originU[k]) + v * load(rays.originV[k]);
        squared += move * move;
      }
      const EightInts isPast1 = t > load(rays.focus1), isPast2 = t > load(rays.focus2), isAhead = t > 0.0f;
      const EightInts isIn[kIntervals] = {isAhead & ~isPast1, isPast1 & ~isPast2, isPast2};
      for (std::size_t k = 0; k < kIntervals; ++k) {
        const EightInts isBetter = isIn[k] & (squared < best[k]);
        best[k] = isBetter ? squared : best[k];
        bestGroup[k] = isBetter ? EightInts{} + std::int32_t(g) : bestGroup[k];
      }
    }
    for (std::size_t k = 0; k < kIntervals; ++k) {
      starts[k].squared = std::numeric_limits<float>::max();
      for (int lane = 0; lane < 8; ++lane)
        if (best[k][lane] < starts[k].squared)
          starts[k] = {std::uint32_t(8 * bestGroup[k][lane] + lane), best[k][lane]};
    }
  }
};

}  // namespace

void IntervalSearch::findStarts(std::span<const RayGroup> groups, const vec3& point,
                                std::array<Start, kIntervals>& starts) {
  core::runOnWidestVectors<FindStarts>(groups, point, starts);
}

}  // namespace catoptric::virtual_object
