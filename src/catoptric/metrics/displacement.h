// SPDX-License-Identifier: Apache-2.0
// How far, in pixels, a method's reflections are from ray-traced truth (methods.md, section 6).
#pragma once

#include <array>
#include <cstdint>

#include "catoptric/core/image.h"
#include "catoptric/core/seen.h"

namespace catoptric::metrics {

inline constexpr float kLostPx = 24.0f;  ///< Also the radius of the search.

/// Steps at which distributions are given, pixels.
inline constexpr std::array<float, 12> kDistributionPx{0.01f, 0.02f, 0.05f, 0.1f,  0.2f,  0.5f,
                                                       1.0f,  2.0f,  5.0f,  10.0f, 15.0f, 20.0f};

struct DisplacementStatistics {
  std::uint64_t pixels = 0;
  double medianPx = 0, p95Px = 0, meanPx = 0;
  double shareWithin1Px = 0, shareWithin2Px = 0, shareLost = 0;  ///< of `pixels`; 0..1
  std::array<double, kDistributionPx.size()> shareWithin{};      ///< at most kDistributionPx[i]
};

struct DisplacementResult {
  core::Image<float> displacementPx;    ///< -1 where the pixel is no mirror pixel
  DisplacementStatistics mirrorPixels;  ///< all mirror pixels of the method
  DisplacementStatistics objectPixels;  ///< those where method or truth shows neither sky nor shell
  double falseCoverage =
      0;  ///< share of mirror pixels that show something where the truth shows the background
  double missedCoverage = 0;  ///< share that show the background where the truth shows something
};

/// Both images have the same size and camera; `footprints` belong to the truth.
[[nodiscard]] DisplacementResult computeDisplacement(const core::SeenImage& method,
                                                     const core::SeenImage& truth,
                                                     const core::FootprintImage& footprints);

}  // namespace catoptric::metrics
