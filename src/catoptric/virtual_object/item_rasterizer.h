// SPDX-License-Identifier: Apache-2.0
// Fills triangles with integers, exactly: pixel centres, 1/256 pixel vertices, top-left rule. Triangles that
// share an edge leave no gap and no pixel twice; there is no blending and no colour rounding that could spoil
// an id (the papers draw ids as colours). Either winding.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

struct EdgeFunction {
  std::int64_t stepX, stepY, value;  // value at the first pixel; inside: value >= 0
};

/// Pixels of a row, counted from its first one.
struct PixelSpan {
  int begin, end;
};

/// Where all three edge functions say inside, of the first `count` pixels of a row. A few are asked one by
/// one, a long row is divided: triangles that run aslant fill little of the box around them.
inline PixelSpan findInside(const std::array<EdgeFunction, 3>& edges, const std::array<std::int64_t, 3>& bias,
                            int count) {
  constexpr int kFew = 6;
  std::int64_t begin = 0, end = count;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t step = edges[i].stepX, first = edges[i].value + bias[i];
    const auto isInside = [&](std::int64_t k) { return first + k * step >= 0; };
    if (step == 0 && first < 0) return {0, 0};
    if (step > 0 && first < 0) {
      if (count > kFew) begin = std::max(begin, (step - 1 - first) / step);
      while (begin < end && !isInside(begin)) ++begin;
    }
    if (step < 0 && count > kFew) end = first < 0 ? 0 : std::min(end, 1 - first / step);
    if (step < 0)
      while (begin < end && !isInside(end - 1)) --end;
  }
  return {int(std::min(begin, end)), int(end)};
}

/// Calls visit(x, y, weights) for every pixel of a width x height raster whose centre lies in the triangle;
/// weights are barycentric. Vertices in pixels, (0,0) the corner of pixel (0,0). Vertices beyond +-10^6 px
/// are refused.
template <class Visit>
void rasterizeTriangle(const std::array<dvec2, 3>& verticesPx, int width, int height, Visit&& visit) {
  constexpr std::int64_t kSub = 256, kOffset = std::int64_t(1) << 30;
  std::array<std::int64_t, 3> x, y;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(verticesPx[i].x) < 1e6) || !(std::abs(verticesPx[i].y) < 1e6)) return;
    // Rounds to nearest; an offset and truncation are faster than std::llround, a function call on x86-64.
    x[i] = std::int64_t(verticesPx[i].x * double(kSub) + (kOffset + 0.5)) - kOffset;
    y[i] = std::int64_t(verticesPx[i].y * double(kSub) + (kOffset + 0.5)) - kOffset;
  }
  std::int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  const bool swapped = area < 0;
  if (swapped) std::swap(x[1], x[2]), std::swap(y[1], y[2]), area = -area;

  const auto floorPixel = [](std::int64_t v) { return (v - kSub / 2 + kSub - 1) >> 8; };  // first centre >= v
  const int x0 = int(std::max<std::int64_t>(0, floorPixel(std::min({x[0], x[1], x[2]}))));
  const int y0 = int(std::max<std::int64_t>(0, floorPixel(std::min({y[0], y[1], y[2]}))));
  const int x1 = int(std::min<std::int64_t>(width - 1, (std::max({x[0], x[1], x[2]}) - kSub / 2) >> 8));
  const int y1 = int(std::min<std::int64_t>(height - 1, (std::max({y[0], y[1], y[2]}) - kSub / 2) >> 8));
  if (x0 > x1 || y0 > y1) return;

  std::array<EdgeFunction, 3> edges;  // edge i lies opposite vertex i
  std::array<std::int64_t, 3> bias;
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    const std::int64_t dx = x[b] - x[a], dy = y[b] - y[a];
    edges[i].stepX = -dy * kSub;
    edges[i].stepY = dx * kSub;
    edges[i].value = dx * (y0 * kSub + kSub / 2 - y[a]) - dy * (x0 * kSub + kSub / 2 - x[a]);
    bias[i] = (dy < 0 || (dy == 0 && dx > 0)) ? 0 : -1;  // a pixel on an edge belongs to one side only
  }
  const double inverseArea = 1.0 / double(area);
  const int count = x1 - x0 + 1;
  for (int py = y0; py <= y1; ++py) {
    const PixelSpan span = findInside(edges, bias, count);
    std::int64_t w0 = edges[0].value + span.begin * edges[0].stepX,
                 w1 = edges[1].value + span.begin * edges[1].stepX,
                 w2 = edges[2].value + span.begin * edges[2].stepX;
    for (int px = x0 + span.begin; px < x0 + span.end; ++px) {
      const dvec3 weights(double(w0) * inverseArea, double(w1) * inverseArea, double(w2) * inverseArea);
      visit(px, py, swapped ? dvec3(weights.x, weights.z, weights.y) : weights);
      w0 += edges[0].stepX, w1 += edges[1].stepX, w2 += edges[2].stepX;
    }
    for (auto& edge : edges) edge.value += edge.stepY;
  }
}

}  // namespace catoptric::virtual_object
