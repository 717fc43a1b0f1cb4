// SPDX-License-Identifier: Apache-2.0
// Light from infinitely far away: a latitude-longitude map of linear radiance, its irradiance and its blurred
// copies for rough surfaces. Every renderer samples these same texels.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::scene {

/// Direction <-> map: see shaders/lib/environment.glsl (u = 0.5 + atan(x, -z) / 2 pi, v = acos(y) / pi).
struct Environment {
  /// Mip chain of the map itself, level 0 first, each half the size; radiance capped to 65504 (half float)
  /// with a warning. u wraps around, v clamps.
  std::vector<core::ImageRgbF> radiance;
  /// The map blurred by the GGX lobe of roughness i / (N-1); small images, all the same size. [0] is a
  /// reduced copy.
  std::vector<core::ImageRgbF> prefiltered;
  /// Irradiance / pi as nine spherical-harmonic coefficients, the cosine lobe already convolved (see
  /// shaders/lib/environment.glsl: evaluateIrradiance).
  std::array<vec3, 9> irradiance{};
};

inline constexpr int kPrefilteredLevels = 8;

/// The built-in sky: blue gradient, soft sun and clouds, ground below the horizon.
[[nodiscard]] Environment makeSkyEnvironment();
/// A constant one, e.g. black for tests.
[[nodiscard]] Environment makeConstantEnvironment(const vec3& radiance);
/// From an equirectangular .hdr or .exr. Throws core::Error.
[[nodiscard]] Environment readEnvironment(const std::filesystem::path& path);
/// From an image in memory.
[[nodiscard]] Environment makeEnvironment(core::ImageRgbF latitudeLongitude);

}  // namespace catoptric::scene
