// SPDX-License-Identifier: Apache-2.0
// Which pixels of a mirror's parts the virtual objects have got right, told by the pixels' own rays.
//
// In:  for each virtual object (of a part and an interval between foci) the triangle whose number was drawn
//      at each pixel; the pixels' reflected rays (world).
// Out: of the triangles that their pixel's ray meets, or misses by no more than a pixel sees of it, the
//      nearest. Pixels without one have no hit: no triangle was drawn there (it has no image by one
//      reflection point a corner: a focus lies in between, or a caustic runs through it), or wrong ones were.
// Cost: about 20 ns a pixel on one core; rows are shared out over all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/gl/framebuffer.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/exact/mirror_tiles.h"
#include "catoptric/virtual_object/number_raster.h"

namespace catoptric::virtual_object {

/// A virtual object as it was drawn.
struct PartPicture {
  gl::Scissor bounds;
  const NumberImage& image;  ///< of its pixels, row by row
  std::uint32_t part;        ///< number of the part whose pixels count
};

/// The pixels of a mirror, row by row.
struct MirrorPixels {
  gl::Scissor bounds;                  ///< a PartPicture's lie within
  std::uint32_t word = 0;              ///< of the mirror in the rays' images
  std::span<const uvec2> partNumbers;  ///< in x
  NumberImage confirmed;               ///< what is right
};

/// Adds what is right in a picture and nearer than what is confirmed already.
void confirmPixels(const scene::WorldGeometry& world, const RayImages& rays, const PartPicture& picture,
                   MirrorPixels& pixels);

}  // namespace catoptric::virtual_object
