// SPDX-License-Identifier: Apache-2.0
// Cuts off what of a triangle lies behind the eye or so far off the picture that it cannot be counted in
// parts of a pixel (Sutherland & Hodgman 1974). For the few triangles that do.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

/// Calls use(corners) for each triangle of what is left: pixels, (0,0) the picture's lower left corner, and
/// 1 / w. `clip`: corners in clip space. What is nearer to the eye's plane than 2^-20 of the farthest corner
/// counts as behind it.
template <class Use>
void clipToScreen(const std::array<vec4, 3>& clip, int widthPx, int heightPx, Use&& use) {
  constexpr float kReach = 16;      // of half the picture
  constexpr std::size_t kMost = 8;  // corners: one more for each plane
  const float largest = glm::max(glm::max(clip[0].w, clip[1].w), clip[2].w);
  if (!(largest > 0.0f) || !std::isfinite(glm::dot(clip[0] + clip[1] + clip[2], vec4(1.0f)))) return;
  const float least = largest / float(1 << 20);
  std::array<vec4, kMost> polygon{clip[0], clip[1], clip[2]}, cut;
  std::size_t count = 3;
  // dot(plane, corner) >= offset
  const std::array<std::pair<vec4, float>, 5> planes{{{{0, 0, 0, 1}, least},
                                                      {{1, 0, 0, kReach}, 0.0f},
                                                      {{-1, 0, 0, kReach}, 0.0f},
                                                      {{0, 1, 0, kReach}, 0.0f},
                                                      {{0, -1, 0, kReach}, 0.0f}}};
  for (const auto& [plane, offset] : planes) {
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const vec4 &a = polygon[k], &b = polygon[(k + 1) % count];
      const float ha = glm::dot(plane, a) - offset, hb = glm::dot(plane, b) - offset;
      if (ha >= 0.0f) cut[left++] = a;
      if ((ha >= 0.0f) != (hb >= 0.0f)) cut[left++] = a + (b - a) * (ha / (ha - hb));
    }
    polygon = cut;
    count = left;
    if (count < 3) return;
  }
  const auto toScreen = [&](const vec4& c) {
    return vec3((c.x / c.w + 1.0f) * 0.5f * float(widthPx), (c.y / c.w + 1.0f) * 0.5f * float(heightPx),
                1.0f / c.w);
  };
  for (std::size_t k = 1; k + 1 < count; ++k)
    use(std::array<vec3, 3>{toScreen(polygon[0]), toScreen(polygon[k]), toScreen(polygon[k + 1])});
}

}  // namespace catoptric::virtual_object
