// SPDX-License-Identifier: Apache-2.0
// Looking eight points up in a map of directions. Included by the files that search in lanes.
#pragma once

#include "catoptric/virtual_object/mirror_law_lanes.h"

namespace catoptric::virtual_object {

/// Where a map shows a point.
struct MapPlace {
  EightInts isInside;
  EightInts index;  ///< of its pixel, 0 where it is not inside
};

CATOPTRIC_INLINE MapPlace findPlace(const LaneMap& map, const LaneVector& local) {
  const LaneVector d = local - broadcast(map.centre);
  const Eight length = squareRoot(dot(d, d));
  const Eight scale =
      1.0f / squareRoot(larger(2.0f * length * (dot(broadcast(map.z), d) + length), Eight{} + 1e-12f));
  const Eight x = (dot(broadcast(map.x), d) * scale - map.lower.x) * map.pixelsPerUnit.x;
  const Eight y = (dot(broadcast(map.y), d) * scale - map.lower.y) * map.pixelsPerUnit.y;
  const Eight size = Eight{} + float(map.size);
  MapPlace place;
  place.isInside = (x >= 0.0f) & (y >= 0.0f) & (x < size) & (y < size);
  const EightInts column = __builtin_convertvector(place.isInside ? x : Eight{}, EightInts),
                  row = __builtin_convertvector(place.isInside ? y : Eight{}, EightInts);
  place.index = row * map.size + column;
  return place;
}

CATOPTRIC_INLINE LaneVector toLocal(const LaneView& view, const LaneVector& world) {
  return world - broadcast(view.centre) - broadcast(view.centreRest);
}

}  // namespace catoptric::virtual_object
