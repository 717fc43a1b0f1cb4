// SPDX-License-Identifier: Apache-2.0
// Differences as pictures, for looking at.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "catoptric/metrics/displacement.h"
#include "catoptric/metrics/image_difference.h"

namespace catoptric::metrics {
namespace {

struct RampStop {
  float displacementPx;
  vec3 colour;  // sRGB, 0..255
};

constexpr float kNearlyLostPx = kLostPx - 1e-3f;
const std::array<RampStop, 5> kRamp{{{0.0f, {18, 38, 110}},
                                     {1.0f, {46, 160, 67}},
                                     {2.0f, {235, 220, 60}},
                                     {8.0f, {240, 140, 30}},
                                     {kNearlyLostPx, {225, 95, 20}}}};
const vec3 kLostColour{200, 16, 16};

vec3 colourOf(float displacementPx) {
  if (displacementPx >= kLostPx) return kLostColour;
  for (std::size_t i = 1; i < kRamp.size(); ++i) {
    const RampStop &low = kRamp[i - 1], &high = kRamp[i];
    if (displacementPx > high.displacementPx) continue;
    const float t = (displacementPx - low.displacementPx) / (high.displacementPx - low.displacementPx);
    return glm::mix(low.colour, high.colour, std::clamp(t, 0.0f, 1.0f));
  }
  return kRamp.back().colour;
}

glm::u8vec4 toPixel(const vec3& colour) {
  const vec3 c = glm::clamp(glm::round(colour), vec3(0), vec3(255));
  return {std::uint8_t(c.r), std::uint8_t(c.g), std::uint8_t(c.b), 255};
}

}  // namespace

core::ImageRgba8 makeDifferencePicture(const core::ImageRgba8& a, const core::ImageRgba8& b, float gain) {
  assert(a.width() == b.width() && a.height() == b.height());
  core::ImageRgba8 picture(a.width(), a.height());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const vec3 difference = glm::abs(vec3(a.pixels()[i]) - vec3(b.pixels()[i]));
    picture.pixels()[i] = toPixel(difference * gain);
  }
  return picture;
}

core::ImageRgba8 makeDisplacementPicture(const core::Image<float>& displacementPx,
                                         const core::ImageRgba8& picture) {
  assert(displacementPx.width() == picture.width() && displacementPx.height() == picture.height());
  core::ImageRgba8 result(picture.width(), picture.height());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const vec3 shown(picture.pixels()[i]);
    const float luma = 0.299f * shown.r + 0.587f * shown.g + 0.114f * shown.b;
    const float value = displacementPx.pixels()[i];
    const vec3 dimmed(0.35f * luma + 20.0f);
    result.pixels()[i] = toPixel(value < 0.0f ? dimmed : glm::mix(colourOf(value), vec3(luma), 0.15f));
  }
  return result;
}

}  // namespace catoptric::metrics
