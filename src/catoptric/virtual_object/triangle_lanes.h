// SPDX-License-Identifier: Apache-2.0
// Edge functions of eight triangles side by side, and which pixels of the small ones have their centre
// inside (number_raster.h, step 1).
//
//   1. Corners to 1/256 of a pixel, rounded to nearest as item_rasterizer.h does; the box of pixels whose
//      centres may lie inside.
//   2. Edge functions as integers at the centre of the box's first pixel, with the top-left rule: neighbours
//      leave no gap and no pixel twice. Nearness, 1 / w, which is linear on the screen, with its steps.
//   3. Of those whose box is kTinyPx wide and high at most, one pixel of all boxes after the other: a bit for
//      each centre inside. Most virtual triangles are as small, and many of them hold no centre at all.
//
// Lanes are triangles, not pixels: a triangle of two or three pixels fills eight pixels badly.
// Pineda 1988, "A parallel algorithm for polygon rasterization".
#pragma once

#include <cstdint>
#include <span>

#include "catoptric/core/math.h"
#include "catoptric/gl/framebuffer.h"

namespace catoptric::virtual_object {

/// Eight triangles. Which ones: bit i for lane i.
struct alignas(64) TriangleGroup {
  static constexpr int kLanes = 8;
  static constexpr int kSub = 256;        ///< of a pixel
  static constexpr int kTinyPx = 8;       ///< so that 64 bits tell which pixels are inside
  static constexpr int kLargestPx = 64;   ///< edge functions of wider triangles do not fit into 32 bits
  static constexpr float kReach = 16000;  ///< pixels off the picture's corner that can be counted in floats
  using Floats = float[kLanes];
  using Ints = std::int32_t[kLanes];

  unsigned wanted = 0;             ///< in
  Floats x[3], y[3], nearness[3];  ///< in: corners in pixels, (0,0) the picture's corner; 1 / w

  unsigned hard = 0;   ///< out: wider, or farther off the picture; their other outputs say nothing
  unsigned tiny = 0;   ///< out: at most kTinyPx pixels wide and high
  unsigned small = 0;  ///< out: larger than that
  Ints x0, y0, width,
      height;  ///< out, of tiny and small: pixels that may be inside, (0,0) the bounds' corner
  Ints edge[3], stepX[3], stepY[3];  ///< out: inside where all three are >= 0
  Floats near, nearX, nearY;         ///< out: nearness at the first pixel's centre, and a pixel on
  Floats least, most;                ///< out: of the corners' nearness
  Ints inside[2];  ///< out, of tiny: bit 8 j + i of [0] for pixel (i, j), of [1] for (i, 4 + j). Outside of
                   ///< the box it says nothing
};

/// Fills in `x`, `y` and `nearness`: corner k of lane i is screen[corners[k][i]]. All lanes are read.
void gatherCorners(std::span<const vec3> screen, const std::uint32_t (&corners)[3][TriangleGroup::kLanes],
                   TriangleGroup& group);

/// Fills the outputs. `bounds`: of the pixels that are drawn. In none of the three: no pixel of the bounds,
/// or no area.
void setUpTriangles(const gl::Scissor& bounds, TriangleGroup& group);

}  // namespace catoptric::virtual_object
