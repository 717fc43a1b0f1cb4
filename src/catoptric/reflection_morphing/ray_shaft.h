// SPDX-License-Identifier: Apache-2.0
// The space that the rays of a trace can reach: a shaft of eight sides that opens away from the mirror.
//
// Most vertices of a scene are not seen in a small mirror. They are told from the others by eight planes
// before any map is searched.
#pragma once

#include <array>

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {

/// A point q of the shaft has normal . q <= offset for every side; world, metres. Without rays, or with rays
/// that leave in all directions, it holds every point.
struct RayShaft {
  static constexpr int kSides = 8;
  using Sides = std::array<float, kSides>;
  alignas(32) Sides normalX{}, normalY{}, normalZ{}, offset{};

  [[nodiscard]] bool mayReach(const vec3& q) const {
    unsigned outside = 0;
    for (std::size_t i = 0; i < kSides; ++i)
      outside |= unsigned(normalX[i] * q.x + normalY[i] * q.y + normalZ[i] * q.z > offset[i]);
    return outside == 0;
  }
};

/// Holds every point of every ray of a continued map, and of the rays interpolated between them.
[[nodiscard]] RayShaft makeRayShaft(const RayMap& map);

}  // namespace catoptric::reflection_morphing
