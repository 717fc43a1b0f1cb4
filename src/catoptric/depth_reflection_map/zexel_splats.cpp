// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/zexel_splats.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::depth_reflection_map {
namespace {

constexpr float kLeastW = 1e-6f;
/// Neighbours whose disparities differ by more than this share lie on different surfaces: a plane differs by
/// one over its distance, in zexels, from where it vanishes.
constexpr float kSurfaceStep = 0.06f;
constexpr float kLargestHalf = 3.5f;  // of a footprint, pixels
constexpr float kSlackPx = 0.06f;     // footprints are first derivatives: close the cracks between them
constexpr float kOutside = -100.0f;

using Lane = std::array<float, kZexelTile>;

/// Where each zexel of a chunk lands.
struct Landing {
  Lane x, y, nearness;  ///< x = kOutside where it does not
  Lane halfX, halfY;    ///< Footprint only
};

/// Step 1.
void land(const float* disparities, int count, const ZexelWarp& warp, const dvec3& first,
          const WinnerImage& image, Landing& landing) {
  const float u0 = float(first.x), v0 = float(first.y), w0 = float(first.z);
  const vec3 perColumn = warp.pixelFromZexel[0] * warp.step, e = warp.perDisparity;
  const float reach = float(WinnerImage::kBorder) / 2;
  const float right = float(image.stride) - reach, top = float(image.rows) - reach;
  for (int i = 0; i < count; ++i) {
    const float d = disparities[i], column = float(i);
    const float w = w0 + column * perColumn.z + d * e.z;
    const float inverse = 1.0f / std::max(w, kLeastW);
    const float x = (u0 + column * perColumn.x + d * e.x) * inverse;
    const float y = (v0 + column * perColumn.y + d * e.y) * inverse;
    const bool inside = (w > kLeastW) & (x > reach) & (x < right) & (y > reach) & (y < top);
    landing.x[std::size_t(i)] = inside ? x : kOutside;
    landing.y[std::size_t(i)] = y;
    landing.nearness[std::size_t(i)] = d * inverse;
  }
}

float slopeOnSurface(float difference, float disparity) {
  return std::abs(difference) <= kSurfaceStep * disparity ? difference : 0.0f;
}

/// Step 4: half the size of each footprint. `along` and `across` point to the next zexel of the row and of
/// the next row, or back with a negative sign at the edges.
void measureFootprints(const float* disparities, const float* next, const float* above, float nextSign,
                       float aboveSign, int count, const ZexelWarp& warp, const dvec3& first,
                       Landing& landing) {
  const float w0 = float(first.z);
  const vec3 perColumn = warp.pixelFromZexel[0] * warp.step, perRow = warp.pixelFromZexel[1] * warp.step;
  const vec3 e = warp.perDisparity;
  for (int i = 0; i < count; ++i) {
    const auto k = std::size_t(i);
    const float d = disparities[i], x = landing.x[k], y = landing.y[k];
    const float gx = nextSign * slopeOnSurface(next[i] - d, d);
    const float gy = aboveSign * slopeOnSurface(above[i] - d, d);
    const float w = w0 + float(i) * perColumn.z + d * e.z;
    const float half = 0.5f / std::max(w, kLeastW);
    const float columnW = perColumn.z + gx * e.z, rowW = perRow.z + gy * e.z;
    const float xx = std::abs(perColumn.x + gx * e.x - x * columnW);
    const float xy = std::abs(perRow.x + gy * e.x - x * rowW);
    const float yx = std::abs(perColumn.y + gx * e.y - y * columnW);
    const float yy = std::abs(perRow.y + gy * e.y - y * rowW);
    landing.halfX[k] = std::min((xx + xy) * half + kSlackPx, kLargestHalf);
    landing.halfY[k] = std::min((yx + yy) * half + kSlackPx, kLargestHalf);
  }
}

/// Pixels [x0, x1] of rows [y0, y1] show the zexel.
template <Visibility V>
inline void fill(WinnerImage& out, int x0, int x1, int y0, int y1, std::uint32_t winner, float nearness) {
  for (int y = y0; y <= y1; ++y) {
    const std::size_t row = std::size_t(y) * std::size_t(out.stride);
    for (int x = x0; x <= x1; ++x) {
      const std::size_t i = row + std::size_t(x);
      if constexpr (V == Visibility::ZBuffer) {
        if (!(nearness > out.nearness[i])) continue;
        out.nearness[i] = nearness;
      }
      out.winners[i] = winner;
    }
  }
}

template <Splat S, Visibility V>
void splat(const ZexelChunk& chunk, const Landing& landing, WinnerImage& out) {
  const int count = chunk.end - chunk.begin;
  for (int k = 0; k < count; ++k) {
    const int i = chunk.leftToRight ? k : count - 1 - k;
    const auto lane = std::size_t(i);
    const float x = landing.x[lane], y = landing.y[lane];
    if (x < 0.0f) continue;
    const std::uint32_t winner = chunk.firstWinner + std::uint32_t(i) * chunk.winnerStep;
    if constexpr (S == Splat::Footprint) {
      const float halfX = landing.halfX[lane], halfY = landing.halfY[lane];
      const float firstX = x - halfX + 0.5f, lastX = x + halfX - 0.5f;
      const float firstY = y - halfY + 0.5f, lastY = y + halfY - 0.5f;
      fill<V>(out, int(firstX), int(lastX), int(firstY), int(lastY), winner, landing.nearness[lane]);
    } else {
      constexpr int kRadius = S == Splat::Square ? 1 : 0;
      const int column = int(x), row = int(y);
      fill<V>(out, column - kRadius, column + kRadius, row - kRadius, row + kRadius, winner,
              landing.nearness[lane]);
    }
  }
}

template <Splat S>
void splatBy(const ZexelChunk& chunk, const Landing& landing, WinnerImage& out) {
  if (out.nearness.empty())
    splat<S, Visibility::Ordered>(chunk, landing, out);
  else
    splat<S, Visibility::ZBuffer>(chunk, landing, out);
}

}  // namespace

void splatChunk(const ZexelLevel& level, const ZexelWarp& warp, const ZexelChunk& chunk, Splat splat,
                WinnerImage& out) {
  Landing landing;
  const int count = chunk.end - chunk.begin;
  const std::size_t row = std::size_t(chunk.y) * std::size_t(level.width);
  const float* disparities = level.disparities.data() + row + chunk.begin;
  land(disparities, count, warp, chunk.firstAtPixel, out, landing);
  if (splat == Splat::Point) return splatBy<Splat::Point>(chunk, landing, out);
  if (splat == Splat::Square) return splatBy<Splat::Square>(chunk, landing, out);
  // The last column and row look back instead of ahead.
  const bool isLastColumn = chunk.end == level.width && level.width > 1,
             isLastRow = chunk.y + 1 == level.height;
  const std::ptrdiff_t along = isLastColumn ? -1 : 1;
  const std::ptrdiff_t across = level.height == 1 ? 0 : isLastRow ? -level.width : level.width;
  const float* next = disparities + (isLastColumn && chunk.begin == 0 ? 0 : level.width == 1 ? 0 : along);
  measureFootprints(disparities, next, disparities + across, float(along), isLastRow ? -1.0f : 1.0f, count,
                    warp, chunk.firstAtPixel, landing);
  splatBy<Splat::Footprint>(chunk, landing, out);
}

}  // namespace catoptric::depth_reflection_map
