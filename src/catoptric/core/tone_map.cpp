// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/tone_map.h"

#include <algorithm>
#include <array>
#include <bit>
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

/// Rounded as by std::lround(), which is a function call: of a float the sum is exact in double.
std::uint8_t toByte(float value) {
  return std::uint8_t(int(2.0 * double(std::clamp(value, 0.0f, 1.0f) * 255.0f) + 1.0) / 2);
}

/// toByte(srgbFromLinear(x)) without its power, which is most of the time of a picture: for each byte the
/// least float that gives it (the function is monotone), and for the upper 16 bits of a float the byte at the
/// start of their interval.
class SrgbBytes {
 public:
  SrgbBytes() {
    for (int byte = 1; byte < 256; ++byte) {
      std::uint32_t below = 0, at = kOne;  // bits of floats in [0, 1] are ordered as the floats are
      while (at - below > 1) {
        const std::uint32_t middle = below + (at - below) / 2;
        (toByte(srgbFromLinear(std::bit_cast<float>(middle))) >= byte ? at : below) = middle;
      }
      least_[std::size_t(byte)] = std::bit_cast<float>(at);
    }
    for (std::uint32_t upper = 0; upper < first_.size(); ++upper)
      first_[upper] = toByte(srgbFromLinear(std::bit_cast<float>(upper << 16)));
  }
  /// `linear` is not negative and not NaN.
  [[nodiscard]] std::uint8_t operator()(float linear) const {
    if (linear >= 1.0f) return 255;
    std::size_t byte = first_[std::bit_cast<std::uint32_t>(linear) >> 16];
    while (byte < 255 && linear >= least_[byte + 1]) ++byte;
    return std::uint8_t(byte);
  }

 private:
  static constexpr std::uint32_t kOne = 0x3f800000u;  // bits of 1.0f
  std::array<float, 256> least_{};
  std::array<std::uint8_t, (kOne >> 16) + 1> first_{};
};

std::uint8_t toSrgbByte(float linear) {
  static const SrgbBytes bytes;
  return bytes(std::max(linear, 0.0f));
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
  return {toSrgbByte(colour.r), toSrgbByte(colour.g), toSrgbByte(colour.b), toByte(linear.a)};
}

ImageRgba8 toneMap(const ImageRgbaF& linear, float exposure) {
  ImageRgba8 result(linear.width(), linear.height());
  parallelFor(linear.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result.data()[i] = toneMap(linear.data()[i], exposure);
  });
  return result;
}

}  // namespace catoptric::core
