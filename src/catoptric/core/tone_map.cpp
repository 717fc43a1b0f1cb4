// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/tone_map.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::core {
namespace {

/// Khronos PBR Neutral (Khronos ToneMapping repository, specification of 2024).
vec3 compressHighlights(vec3 colour) {
  constexpr float kStartCompression = 0.8f - 0.04f;
  constexpr float kDesaturation = 0.15f;
  const float smallest = std::min({colour.r, colour.g, colour.b});
  const float offset = smallest < 0.08f ? smallest - 6.25f * smallest * smallest : 0.04f;
  colour -= offset;
  const float peak = std::max({colour.r, colour.g, colour.b});
  if (peak < kStartCompression) return colour;
  const float d = 1.0f - kStartCompression;
  const float newPeak = 1.0f - d * d / (peak + d - kStartCompression);
  colour *= newPeak / peak;
  const float g = 1.0f - 1.0f / (kDesaturation * (peak - newPeak) + 1.0f);
  return glm::mix(colour, vec3(newPeak), g);
}

std::uint8_t toByte(float value) {
  return std::uint8_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

}  // namespace

float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

glm::u8vec4 toneMap(const vec4& linear, float exposure) {
  vec3 colour = vec3(linear) * exposure;
  for (int i = 0; i < 3; ++i)
    if (!(colour[i] > 0.0f)) colour[i] = 0.0f;  // catches NaN too
  colour = glm::min(colour, vec3(1e6f));
  colour = compressHighlights(colour);
  return {toByte(srgbFromLinear(colour.r)), toByte(srgbFromLinear(colour.g)),
          toByte(srgbFromLinear(colour.b)), toByte(linear.a)};
}

ImageRgba8 toneMap(const ImageRgbaF& linear, float exposure) {
  ImageRgba8 result(linear.width(), linear.height());
  parallelFor(linear.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result.data()[i] = toneMap(linear.data()[i], exposure);
  });
  return result;
}

}  // namespace catoptric::core
