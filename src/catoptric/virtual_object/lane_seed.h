// SPDX-License-Identifier: Apache-2.0
// Where the maps say that the searches of eight vertices should begin. Included by lane_search.cpp.
#pragma once

#include <cstdint>
#include <cstring>

#include "catoptric/virtual_object/lane_map.h"

namespace catoptric::virtual_object {

/// A place on the mirror in each lane.
struct Places {
  EightInts triangle;
  Eight u, v;
};

CATOPTRIC_INLINE Places choose(const EightInts& which, const Places& yes, const Places& no) {
  return {which ? yes.triangle : no.triangle, which ? yes.u : no.u, which ? yes.v : no.v};
}

/// Step 1 of lane_search.h: where the eye sees the blend of what the near and the far map say, in the
/// triangle that the hidden map shows there.
CATOPTRIC_INLINE Places seed(const LaneView& view, const LaneVector& local) {
  const LaneVector d = local - broadcast(view.seedMap.centre);
  const Eight layer =
      (1.0f / squareRoot(larger(dot(d, d), Eight{} + 1e-30f)) - view.inverseNear) * view.layersPerInverse;
  const Eight nearWeight = 1.0f - smaller(larger(layer, Eight{}), Eight{} + 1.0f);
  const MapPlace place = findPlace(view.seedMap, local);
  static_assert(sizeof(SeedPixel) == sizeof(Eight));
  Eights seeds;
  for (int i = 0; i < kLanes; ++i) seeds[i] = load(&view.seeds[std::uint32_t(place.index[i])].nearPosition.x);
  core::transpose(seeds);
  EightInts nearTriangle, farTriangle;
  std::memcpy(&nearTriangle, &seeds[3], sizeof nearTriangle);
  std::memcpy(&farTriangle, &seeds[7], sizeof farTriangle);
  const LaneVector near{{seeds[0], seeds[1], seeds[2]}}, far{{seeds[4], seeds[5], seeds[6]}};
  const LaneVector target = toLocal(view, nearWeight * near + (1.0f - nearWeight) * far);
  const MapPlace shown = findPlace(view.hiddenMap, target);
  EightInts triangle;
  for (int i = 0; i < kLanes; ++i) triangle[i] = std::int32_t(view.hiddenIds[std::uint32_t(shown.index[i])]);
  const EightInts isShown = shown.isInside & (triangle != std::int32_t(core::kNoId));
  Places at;
  at.triangle = isShown ? triangle : nearWeight >= 0.5f ? nearTriangle : farTriangle;
  Triangles t;
  gather(view.triangles, at.triangle, t);
  const LaneVector inTriangle = target - t.position0;
  const Eight a = dot(t.edge1, inTriangle), b = dot(t.edge2, inTriangle);
  const Eight u = larger(t.gram11 * a + t.gram12 * b, Eight{}),
              v = larger(t.gram12 * a + t.gram22 * b, Eight{});
  const Eight inside = 1.0f / larger(u + v, Eight{} + 1.0f);
  at.u = isShown ? u * inside : Eight{} + 1.0f / 3;
  at.v = isShown ? v * inside : Eight{} + 1.0f / 3;
  return at;
}

}  // namespace catoptric::virtual_object
