// SPDX-License-Identifier: Apache-2.0
// A flat mirror as a textured surface (2005, section 17.1.2, figure 17.4): the mirrored scene is drawn into a
// texture from the same viewpoint, within the mirror's bounds only, and the mirror's pixels look it up by
// their window coordinates. Apart from the picture, it may have a lower resolution.
#pragma once

#include <memory>
#include <vector>

#include "catoptric/raster/reflection_method.h"

namespace catoptric::planar_mirror {

class ProjectiveTexture {
 public:
  /// Draws `ranges` as `mirrored` sees them and gives each pixel of the chain's last mirror what it shows;
  /// depth is not written.
  void draw(raster::FrameContext& frame, const raster::Chain& chain, const raster::PinholeView& mirrored,
            const std::vector<raster::DrawRange>& ranges, const raster::Level& parent, raster::Level& target);

 private:
  gl::Program program_{"raster/screen.vert", "planar_mirror/projective_texture.frag"};
  gl::Program overlayProgram_{"raster/screen.vert", "planar_mirror/projective_texture.frag", {"OVERLAY"}};
  std::unique_ptr<raster::Level> texture_;  ///< of the last size
  gl::VertexArray nothing_;
};

}  // namespace catoptric::planar_mirror
