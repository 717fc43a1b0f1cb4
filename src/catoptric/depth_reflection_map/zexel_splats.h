// SPDX-License-Identifier: Apache-2.0
// The inner loop of the forward warp: a chunk of one row of zexels, first where they land (vectorised), then
// the splats one after the other.
#pragma once

#include "catoptric/depth_reflection_map/forward_warp.h"

namespace catoptric::depth_reflection_map {

/// Eq. 3 in pixels of the winner image: pixelFromZexel (x, y, 1) + d perDisparity.
struct ZexelWarp {
  mat3 pixelFromZexel;
  vec3 perDisparity;
  float step;  ///< zexels of level 0 from one zexel to the next
};

/// Zexels [begin, end) of row y, at most kZexelTile.
struct ZexelChunk {
  int y = 0, begin = 0, end = 0;
  bool leftToRight = true;
  dvec3 firstAtPixel{0};  ///< image of the first zexel at disparity 0, homogeneous
  std::uint32_t firstWinner = 0, winnerStep = 1;
};

void splatChunk(const ZexelLevel& level, const ZexelWarp& warp, const ZexelChunk& chunk, Splat splat,
                WinnerImage& out);

}  // namespace catoptric::depth_reflection_map
