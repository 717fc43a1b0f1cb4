// SPDX-License-Identifier: Apache-2.0
// Where a run of zexels lands in the new picture, and which pixels each of them fills: the arithmetic of the
// forward warp, many zexels at a time.
#pragma once

#include <array>
#include <cstdint>

#include "catoptric/core/math.h"
#include "catoptric/depth_reflection_map/zexel_map.h"
#include "catoptric/depth_reflection_map/zexel_options.h"

namespace catoptric::depth_reflection_map {

/// Eq. 3 in pixels of the winner image: pixelFromZexel (x, y, 1) + d perDisparity.
struct ZexelWarp {
  mat3 pixelFromZexel;
  vec3 perDisparity;
  float step;        ///< zexels of level 0 from one zexel to the next
  int stride, rows;  ///< of the winner image
  float reach;       ///< zexels land at least this far from its edges, pixels
};

constexpr int kMostZexels = 4 * kZexelTile;  ///< of one chunk

/// Zexels of one row that follow one another. Lanes are filled in eights: up to seven floats behind the last
/// one are read, and not looked at.
struct ZexelChunk {
  const float* here = nullptr;  ///< disparities
  const float* next = nullptr;  ///< of their neighbours in the row, and in the next row
  const float* above = nullptr;
  float nextSign = 1, aboveSign = 1;  ///< -1 where these are the neighbours on the other side
  int count = 0;                      ///< 1 to kMostZexels
  vec3 firstAtPixel{0};               ///< image of the first zexel at disparity 0, homogeneous
};

/// Pixels from `lower` up to and including `upper`; as it is made, none.
struct PixelBox {
  ivec2 lower{1 << 30}, upper{-1};

  [[nodiscard]] bool isEmpty() const { return upper.x < lower.x; }
  void include(const PixelBox& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
};

/// What each zexel of a chunk fills: pixels `first` + k and the same in the rows above. One that fills
/// nothing has `first` 0, the corner of the border, and no others.
struct Landing {
  template <class T>
  using Lanes = std::array<T, kMostZexels>;

  alignas(32) Lanes<float> nearness;  ///< 1 / depth, of any unit
  alignas(32) Lanes<std::int32_t> first;
  alignas(32) Lanes<std::int32_t> columns;  ///< after the first one
  alignas(32) Lanes<std::int32_t> rows;     ///< after the first one, times the stride
  int mostColumns = 0, mostRows = 0;        ///< after the first one
  PixelBox box;                             ///< of all pixels that are filled
};

/// Steps 1 and 4 of forward_warp.h.
void landZexels(const ZexelChunk& chunk, const ZexelWarp& warp, Splat splat, Landing& landing);

}  // namespace catoptric::depth_reflection_map
