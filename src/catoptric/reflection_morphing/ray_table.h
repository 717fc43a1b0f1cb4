// SPDX-License-Identifier: Apache-2.0
// A ray map as it is searched: 16 bytes a ray after one mirror, 32 after several.
//
// The frame of a table is that of its chart, with the location as origin: x along chart.right, y along
// chart.up, z along chart.axis, metres.
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {

struct RayTable {
  Trace trace;
  vec3 location{0};
  Chart chart;
  vec2 lower{0}, step{0};     ///< chart point of texel (0, 0), and per texel
  int size = 0;               ///< texels along an edge
  std::vector<vec4> leaving;  ///< direction in which the ray leaves (table's frame), distance as in RayTexel
  std::vector<vec4>
      origins;  ///< last mirror point (table's frame), between as in RayTexel; none for one mirror
  /// By texel, of the cell that has it as its lower corner: kFilled where it can be interpolated, kRay << k
  /// where corner k = dx + 2 dy is a ray and not a continuation.
  std::vector<std::uint8_t> cells;
  static constexpr unsigned kFilled = 1, kRay = 2;

  [[nodiscard]] std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(size) + std::size_t(x);
  }
  /// Can it be interpolated at p, in texels?
  [[nodiscard]] bool isFilled(const vec2& p) const {
    const bool isOnMap = unsigned(p.x >= 0) & unsigned(p.y >= 0) & unsigned(p.x < float(size - 1)) &
                         unsigned(p.y < float(size - 1));
    return isOnMap && (cells[at(int(p.x), int(p.y))] & kFilled) != 0;
  }
  [[nodiscard]] std::size_t countRays() const;
};

/// `map` must be continued.
[[nodiscard]] RayTable makeRayTable(const RayMap& map);

}  // namespace catoptric::reflection_morphing
