// SPDX-License-Identifier: Apache-2.0
// Brightness differences between two pictures.
#pragma once

#include <limits>

#include "catoptric/core/image.h"

namespace catoptric::metrics {

struct ImageDifference {
  std::uint64_t pixels = 0;                                 ///< compared ones
  double psnrDb = std::numeric_limits<double>::infinity();  ///< infinite when equal
  double ssim = 1;            ///< luma, 11x11 Gaussian window, sigma 1.5 (Wang et al. 2004)
  double shareWithin4 = 1;    ///< pixels whose largest channel difference is at most 4/255
  int largestDifference = 0;  ///< of any channel, 0..255
  double meanDifference = 0;  ///< of all channels, 0..255
};

/// Compares 8-bit sRGB pictures of one size where mask is non-zero (everywhere if the mask is empty).
[[nodiscard]] ImageDifference compareImages(const core::ImageRgba8& a, const core::ImageRgba8& b,
                                            const core::Image<std::uint8_t>& mask = {});

/// Absolute difference times `gain`, for looking at.
[[nodiscard]] core::ImageRgba8 makeDifferencePicture(const core::ImageRgba8& a, const core::ImageRgba8& b,
                                                     float gain = 8.0f);

/// Displacement as colours (dark blue 0, green 1, yellow 2, orange 8, red lost) over a dimmed picture; for
/// looking at.
[[nodiscard]] core::ImageRgba8 makeDisplacementPicture(const core::Image<float>& displacementPx,
                                                       const core::ImageRgba8& picture);

}  // namespace catoptric::metrics
