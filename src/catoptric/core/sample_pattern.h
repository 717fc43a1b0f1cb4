// SPDX-License-Identifier: Apache-2.0
// Where the samples of a pixel lie: the rasterizer and the ray tracer use the same points.
#pragma once

#include "catoptric/core/math.h"

namespace catoptric::core {

/// Sub-pixel position of sample `index` of `count`, in [0,1)^2. One sample: the pixel's centre. Otherwise the
/// R2 sequence (Roberts 2018), the same for every pixel.
[[nodiscard]] inline dvec2 samplePosition(int index, int count) {
  if (count <= 1) return {0.5, 0.5};
  const double x = 0.5 + 0.7548776662466927 * (index + 1), y = 0.5 + 0.5698402909980532 * (index + 1);
  return {x - glm::floor(x), y - glm::floor(y)};
}

}  // namespace catoptric::core
