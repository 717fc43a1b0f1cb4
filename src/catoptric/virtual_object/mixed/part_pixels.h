// SPDX-License-Identifier: Apache-2.0
// Which pixels of a mirror's parts the virtual objects have got right, told by the pixels' own rays.
//
// In:  the triangle whose number was drawn at each pixel; the pixels' reflected rays (world).
// Out: a pixel is done if its ray meets that triangle, or misses it by no more than a pixel sees of it. The
//      others have lost their hit: no triangle was drawn there (it has no image by one reflection point a
//      corner: a focus lies in between, or a caustic runs through it), or a wrong one was.
// Cost: about 20 ns a pixel on one core; rows are shared out over all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/gl/framebuffer.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/exact/tile_cover.h"

namespace catoptric::virtual_object {

/// `hits`: of `bounds`, row by row, x = triangle + 1; set to 0 where it was wrong. `isDone` runs parallel.
/// `word`: of the mirror's pixels in `rays`. How many are done.
std::size_t checkPixels(const scene::WorldGeometry& world, const RayImages& rays, const gl::Scissor& bounds,
                        std::uint32_t word, std::span<uvec2> hits, std::span<std::uint8_t> isDone);

}  // namespace catoptric::virtual_object
