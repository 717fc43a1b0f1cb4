// SPDX-License-Identifier: Apache-2.0
// The pixels of a mirror before and after its triangles are drawn (number_raster.h, step 3), eight at a time.
#pragma once

#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/virtual_object/number_raster.h"

namespace catoptric::virtual_object {

/// A second triangle is about as near as the first, for virtual triangles sag, from this share of its
/// nearness, 1 / w, on. Where a mirror is 140 px wide they sag half as much.
inline constexpr float kAboutAsNear = 0.99f;

/// From a pixel to the ray through it, and from 1 / w to depth.
struct PixelRays {
  vec3 corner, stepX, stepY;  ///< draw space, a step along the camera's axis long
  float depth, depthStep;

  explicit PixelRays(const NumberPicture& picture);
};

/// Empties rows [begin, end), with the largest 1 / w that lies behind the mirror as their limits; -1 where
/// the mirror is not.
void beginRows(const NumberPicture& picture, const PixelRays& rays, int begin, int end,
               const NumberRaster::Rows& rows);

/// Rows [begin, end) as hits and, where they are asked for, depths.
void finishRows(const NumberPicture& picture, const PixelRays& rays, int begin, int end,
                const NumberRaster::Rows& rows, NumberImage& image);

/// Of rows [begin, end), whose hits are there: where the second nearest triangle is nearly as near.
void findRivals(int begin, int end, const NumberRaster::Rows& rows, std::span<const uvec2> hits,
                std::span<const float> depths, std::vector<Rival>& found);

/// Of rows [begin, end), once all rows have their hits: at pixels of the mirror that show nothing, what is
/// shown beside them. Added to `found`.
void findNeighbours(const NumberPicture& picture, int begin, int end, const NumberImage& image,
                    std::vector<Rival>& found);

}  // namespace catoptric::virtual_object
