// SPDX-License-Identifier: Apache-2.0
// One loop over the lanes, written once; the compiler makes vectors of it, and it is compiled twice: for the
// processors that everyone has and for AVX2. Products and sums are not fused, so both give the same bits.
#include "catoptric/depth_reflection_map/zexel_landing.h"

#include <algorithm>
#include <cmath>

namespace catoptric::depth_reflection_map {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define CATOPTRIC_HAS_AVX2_CLONE
#endif
#define CATOPTRIC_INLINE __attribute__((always_inline)) inline

constexpr int kLaneWidth = 8;
constexpr float kLeastW = 1e-6f;
/// Neighbours whose disparities differ by more than this share lie on different surfaces: a plane differs by
/// one over its distance, in zexels, from where it vanishes.
constexpr float kSurfaceStep = 0.06f;
constexpr float kLargestHalf = 3.5f;  // of a footprint, pixels
constexpr float kSlackPx = 0.06f;     // footprints are first derivatives: close the cracks between them

/// 1 or 0 as a mask of bits: a condition would be a branch, and a loop with branches is not made into
/// vectors.
CATOPTRIC_INLINE int maskOf(bool condition) {
  return -int(condition);
}

CATOPTRIC_INLINE float slopeOnSurface(float difference, float disparity) {
  return std::abs(difference) <= kSurfaceStep * disparity ? difference : 0.0f;
}

/// How far a zexel reaches, in pixels, when neighbours along both axes lie (xx, yx) and (xy, yy) from it: up
/// to the middle of the last pixel. The order of the arguments of min() lets no NaN through.
CATOPTRIC_INLINE float reachOf(float along, float across, float half) {
  return std::min(kLargestHalf, (along + across) * half + kSlackPx) - 0.5f;
}

template <Splat S>
CATOPTRIC_INLINE void landAll(const ZexelChunk& chunk, const ZexelWarp& warp, Landing& landing) {
  const float u0 = chunk.firstAtPixel.x, v0 = chunk.firstAtPixel.y, w0 = chunk.firstAtPixel.z;
  const vec3 perColumn = warp.pixelFromZexel[0] * warp.step, perRow = warp.pixelFromZexel[1] * warp.step;
  const float columnU = perColumn.x, columnV = perColumn.y, columnW = perColumn.z;
  const float rowU = perRow.x, rowV = perRow.y, rowW = perRow.z;
  const float eU = warp.perDisparity.x, eV = warp.perDisparity.y, eW = warp.perDisparity.z;
  const float nextSign = chunk.nextSign, aboveSign = chunk.aboveSign;
  const float *here = chunk.here, *next = chunk.next, *above = chunk.above;
  const float least = warp.reach, right = float(warp.stride) - least, top = float(warp.rows) - least;
  const int count = (chunk.count + kLaneWidth - 1) / kLaneWidth * kLaneWidth, stride = warp.stride;
  float* const nearnessLanes = landing.nearness.data();
  std::int32_t *const firstLanes = landing.first.data(), *const columnsLanes = landing.columns.data(),
                      *const rowsLanes = landing.rows.data();
  constexpr int kFar = 1 << 30;
  int mostColumns = 0, mostRows = 0, lowX = kFar, lowY = kFar, highX = -1, highY = -1;
  for (int i = 0; i < count; ++i) {
    // 1
    const float d = here[i], column = float(i);
    const float w = w0 + column * columnW + d * eW;
    const float inverse = 1.0f / std::max(w, kLeastW);
    const float x = (u0 + column * columnU + d * eU) * inverse;
    const float y = (v0 + column * columnV + d * eV) * inverse;
    // 4. A zexel moved by one column or row, its disparity along with its surface, moves by the quotient
    // rule.
    float reachX = S == Splat::Square ? 1.0f : 0.0f, reachY = reachX;
    if constexpr (S == Splat::Footprint) {
      const float gx = nextSign * slopeOnSurface(next[i] - d, d),
                  gy = aboveSign * slopeOnSurface(above[i] - d, d);
      const float alongW = columnW + gx * eW, acrossW = rowW + gy * eW;
      reachX = reachOf(std::abs(columnU + gx * eU - x * alongW), std::abs(rowU + gy * eU - x * acrossW),
                       0.5f * inverse);
      reachY = reachOf(std::abs(columnV + gx * eV - y * alongW), std::abs(rowV + gy * eV - y * acrossW),
                       0.5f * inverse);
    }
    const float px = std::min(right, std::max(least, x)), py = std::min(top, std::max(least, y));
    const int x0 = int(px - reachX), y0 = int(py - reachY);
    const int columns = int(px + reachX) - x0, rows = int(py + reachY) - y0;
    const int shown = maskOf(w > kLeastW) & maskOf(x > least) & maskOf(x < right) & maskOf(y > least) &
                      maskOf(y < top) & maskOf(columns >= 0) & maskOf(rows >= 0);
    nearnessLanes[i] = d * inverse;
    firstLanes[i] = (y0 * stride + x0) & shown;
    columnsLanes[i] = columns & shown;
    rowsLanes[i] = rows * stride & shown;
    mostColumns = std::max(mostColumns, columns & shown);
    mostRows = std::max(mostRows, rows & shown);
    lowX = std::min(lowX, (x0 & shown) | (kFar & ~shown));
    lowY = std::min(lowY, (y0 & shown) | (kFar & ~shown));
    highX = std::max(highX, (x0 + columns) | ~shown);
    highY = std::max(highY, (y0 + rows) | ~shown);
  }
  landing.box = {{lowX, lowY}, {highX, highY}};
  landing.mostColumns = mostColumns;
  landing.mostRows = mostRows;
}

using Land = void (*)(const ZexelChunk&, const ZexelWarp&, Landing&);

template <Splat S>
void landForEveryone(const ZexelChunk& chunk, const ZexelWarp& warp, Landing& landing) {
  landAll<S>(chunk, warp, landing);
}

#ifdef CATOPTRIC_HAS_AVX2_CLONE
template <Splat S>
__attribute__((target("avx2"))) void landWithAvx2(const ZexelChunk& chunk, const ZexelWarp& warp,
                                                  Landing& landing) {
  landAll<S>(chunk, warp, landing);
}
#endif

std::array<Land, 3> chooseLanding() {
#ifdef CATOPTRIC_HAS_AVX2_CLONE
  if (__builtin_cpu_supports("avx2"))
    return {landWithAvx2<Splat::Point>, landWithAvx2<Splat::Square>, landWithAvx2<Splat::Footprint>};
#endif
  return {landForEveryone<Splat::Point>, landForEveryone<Splat::Square>, landForEveryone<Splat::Footprint>};
}

}  // namespace

void landZexels(const ZexelChunk& chunk, const ZexelWarp& warp, Splat splat, Landing& landing) {
  static const std::array<Land, 3> table = chooseLanding();
  table[std::size_t(splat)](chunk, warp, landing);
}

}  // namespace catoptric::depth_reflection_map
