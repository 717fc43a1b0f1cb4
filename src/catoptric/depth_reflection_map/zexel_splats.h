// SPDX-License-Identifier: Apache-2.0
// The inner loop of the forward warp: a chunk of one row of zexels, first where they land (in lanes), then
// the splats one after the other.
#pragma once

#include "catoptric/depth_reflection_map/forward_warp.h"
#include "catoptric/depth_reflection_map/zexel_landing.h"

namespace catoptric::depth_reflection_map {

/// What the pixels of a chunk's zexels are to say, and in which order the zexels are taken.
struct WinnerRun {
  std::uint32_t first = 0, step = 1;
  bool leftToRight = true;
};

/// `out` has a nearness where the nearer wins; else the later does. The corner of its border is of no use
/// afterwards.
void splatZexels(const ZexelChunk& chunk, const ZexelWarp& warp, const WinnerRun& run, Splat splat,
                 WinnerImage& out);

}  // namespace catoptric::depth_reflection_map
