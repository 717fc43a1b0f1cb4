// SPDX-License-Identifier: Apache-2.0
// In which small rectangles of a mirror's pixels each part of the scene is seen.
//
// Rasterizers shade 4x4 pixels together (Mesa's llvmpipe does, whatever of them is covered), so rectangles
// are made of such blocks, counted from the picture's corner: a block is shaded once for each part that is
// seen in it, not once for each rectangle that touches it. Blocks that are not all of one mirror are listed
// apart, because shading them needs to know which neighbours are of it: a ring of single blocks along the
// mirror's rim.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/virtual_object/hit_shading.h"

namespace catoptric::virtual_object {

/// Pixels at which parts are seen, in the order of parts: small rectangles. `edges`: those with pixels in
/// between that are not of the mirror.
struct PartRects {
  std::vector<CoverRect> inner, edges;
  std::vector<gl::Scissor> rest;  ///< around the mirror's pixels at which no part is seen
  std::vector<PartRects> rows;    ///< scratch
};

/// From the hits of `bounds` (HitShading::readHits()), the part of each triangle by its number, and the
/// level's ids (FrameContext::parentIds), whose rows are `widthPx` long; pixels of the mirror have the word
/// `parentWord`.
void findPartRects(std::span<const std::uint32_t> triangleParts, const gl::Scissor& bounds,
                   std::span<const uvec2> hits, std::span<const uvec2> parentIds, int widthPx,
                   std::uint32_t parentWord, PartRects& rects);

}  // namespace catoptric::virtual_object
