// SPDX-License-Identifier: Apache-2.0
// Linear radiance to the 8-bit sRGB of a PNG.
#pragma once

#include "catoptric/core/image.h"

namespace catoptric::core {

/// Khronos PBR Neutral tone mapping (colours below 0.8 stay as they are, highlights are compressed towards
/// white without a change of hue), then the sRGB transfer function, rounded to 8 bits. `exposure` multiplies
/// radiance first; NaN and negative values become 0. Alpha is passed through.
[[nodiscard]] glm::u8vec4 toneMap(const vec4& linear, float exposure = 1.0f);
[[nodiscard]] ImageRgba8 toneMap(const ImageRgbaF& linear, float exposure = 1.0f);

/// The two halves of the sRGB transfer function, on [0, 1].
[[nodiscard]] float srgbFromLinear(float linear);
[[nodiscard]] float linearFromSrgb(float srgb);

}  // namespace catoptric::core
