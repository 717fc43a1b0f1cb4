// SPDX-License-Identifier: Apache-2.0
// Mip levels made on the CPU, so that the rasterizer uploads and the ray tracer reads the same texels.
#pragma once

#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::scene {

/// The image (level 0) and its halves down to 1 x 1. Each level is max(1, size / 2) of the one before and the
/// mean of 2 x 2 of its texels, rounded to nearest; the last row or column of an odd size is left out. With
/// `srgb`, red, green and blue are averaged as linear light and stored as sRGB again; alpha is always linear.
/// Empty for an empty image.
[[nodiscard]] std::vector<core::ImageRgba8> makeMipChain(const core::ImageRgba8& image, bool srgb);

}  // namespace catoptric::scene
