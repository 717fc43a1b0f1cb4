// SPDX-License-Identifier: Apache-2.0
// Private to scene: integrals over a latitude-longitude map.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::scene {

inline constexpr int kPrefilteredWidth = 128, kPrefilteredHeight = 64;

/// The inverse of latLongFromDirection() in shaders/lib/environment.glsl.
[[nodiscard]] dvec3 directionFromLatLong(double u, double v);

/// Bilinear; u wraps around, v clamps, as the samplers of the renderers do.
[[nodiscard]] vec3 sampleLatLong(const core::ImageRgbF& map, float u, float v);

/// `mips` is the whole chain, level 0 first. See environment.h for the results.
[[nodiscard]] std::vector<core::ImageRgbF> prefilterEnvironment(std::span<const core::ImageRgbF> mips,
                                                                int levels);
[[nodiscard]] std::array<vec3, 9> projectIrradiance(std::span<const core::ImageRgbF> mips);

}  // namespace catoptric::scene
