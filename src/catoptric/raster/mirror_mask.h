// SPDX-License-Identifier: Apache-2.0
// Keeps what is drawn for a mirror within the mirror's pixels, by the stencil or the depth buffer, instead of
// looking their ids up in each fragment (2005, section 17.1.2).
//
// What a mirror's pixels are, an image says: ids of the level before. So the "reflector" that the text draws
// into the stencil is a pass over that image, which also holds for curved mirrors and for mirrors in mirrors.
// Departures: a value of the stencil for each mirror, so that mirrors of one level do not get into each
// other's pixels, not even when erasing; the text's depth masking leaks wherever nothing surrounds the
// mirror, ours makes all other pixels the nearest.
#pragma once

#include <memory>

#include "catoptric/raster/merge.h"
#include "catoptric/raster/surface_pass.h"

namespace catoptric::raster {

class MirrorMask {
 public:
  /// Makes `target` ready for the surfaces that a chain's last mirror shows, and says how they may be drawn;
  /// a method may look up ids nevertheless. By ids where `merge` is not done here, where the target has no
  /// stencil, or none of its 255 values is left.
  [[nodiscard]] Masking begin(Merge merge, const Chain& chain, const Level& parent, Level& target);
  /// After all of them are drawn.
  void end(const Chain& chain, const Level& parent, Level& target);

 private:
  void markStencil(const Chain& chain, const Level& parent);
  void maskDepth(const Chain& chain, const Level& parent);
  void drawMask(gl::Program& program, const Chain& chain, const Level& parent, const gl::DrawState& state);
  void erase(const Chain& chain, Level& target);

  Merge merge_ = Merge::Ids;  ///< of the mirror that is being drawn
  std::uint8_t value_ = 0;
  std::unique_ptr<gl::Program> stencil_, depth_, erase_;  ///< made when first needed
  gl::VertexArray nothing_;
};

}  // namespace catoptric::raster
