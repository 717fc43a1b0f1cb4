// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/environment_mips.h"

#include <algorithm>
#include <utility>

#include "catoptric/core/parallel.h"

namespace catoptric::scene {
namespace {

/// Which source texels make one texel of the next level: two, or three where the size is odd, so that each
/// source texel counts the same in total.
struct Taps {
  int first = 0, count = 1;
  float weights[3] = {1, 0, 0};
};

Taps findTaps(int i, int sourceSize) {
  const int half = sourceSize / 2;
  if (sourceSize == 1) return {};
  if (sourceSize % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0.0f}};
  const float n = float(sourceSize);
  return {2 * i, 3, {float(half - i) / n, float(half) / n, float(i + 1) / n}};
}

core::ImageRgbF halveImage(const core::ImageRgbF& source) {
  core::ImageRgbF result(std::max(source.width() / 2, 1), std::max(source.height() / 2, 1));
  core::parallelFor(std::size_t(result.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const Taps rows = findTaps(int(y), source.height());
      for (int x = 0; x < result.width(); ++x) {
        const Taps columns = findTaps(x, source.width());
        vec3 sum(0);
        for (int j = 0; j < rows.count; ++j) {
          const vec3* texels = &source.at(columns.first, rows.first + j);
          vec3 rowSum(0);  // apart, so that equal texels give exactly that texel
          for (int i = 0; i < columns.count; ++i) rowSum += texels[i] * columns.weights[i];
          sum += rowSum * rows.weights[j];
        }
        result.at(x, int(y)) = sum;
      }
    }
  });
  return result;
}

}  // namespace

std::vector<core::ImageRgbF> makeEnvironmentMips(core::ImageRgbF map) {
  std::vector<core::ImageRgbF> levels;
  levels.push_back(std::move(map));
  while (levels.back().size() > 1) levels.push_back(halveImage(levels.back()));
  return levels;
}

}  // namespace catoptric::scene
