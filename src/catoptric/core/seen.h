// SPDX-License-Identifier: Apache-2.0
// What a frame shows, not how bright it is: which world point is seen at each pixel, through how many
// mirrors. The raster methods and the ray-traced truth both fill this; the metrics compare the two
// (methods.md, section 6).
#pragma once

#include <cstdint>

#include "catoptric/core/image.h"

namespace catoptric::core {

inline constexpr std::uint32_t kNoId = 0xffffffffu;  ///< "nothing": the sky as object, no reflector, ...

/// The last surface of the path that starts at the eye through the pixel's centre.
struct SeenPixel {
  vec3 point{0};                         ///< World point; for the sky the unit direction in which it is seen.
  std::uint32_t object = kNoId;          ///< Index into WorldGeometry::parts' `object`; kNoId = sky.
  std::uint32_t triangle = kNoId;        ///< Index of the world triangle; kNoId = sky.
  std::uint32_t firstReflector = kNoId;  ///< Index of the reflector hit first; kNoId = pixel shows no mirror.
  std::uint32_t bounces = 0;             ///< Mirror bounces between the eye and the point.
  std::uint32_t shell = 0;  ///< 1 where the object belongs to the shell of the room (walls, floor, road).
  float pathLength = 0;     ///< Length of the path from the eye; infinity for the sky.

  [[nodiscard]] bool isSky() const { return object == kNoId; }
  [[nodiscard]] bool isMirror() const { return firstReflector != kNoId; }
};

using SeenImage = Image<SeenPixel>;

/// How the seen point moves per pixel, from ray differentials; only the ray tracer gives it.
struct Footprint {
  vec3 dPdx{0};  ///< Change of SeenPixel::point per pixel to the right (of the direction, for the sky).
  vec3 dPdy{0};  ///< Change per pixel downwards.
};

using FootprintImage = Image<Footprint>;

}  // namespace catoptric::core
