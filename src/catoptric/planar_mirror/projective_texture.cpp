// SPDX-License-Identifier: Apache-2.0
// Steps: 1 the mirrored scene into the texture, frustum reduced to the mirror, 2 the texture onto the mirror.
#include "catoptric/planar_mirror/projective_texture.h"

#include <algorithm>
#include <cmath>

#include "catoptric/planar_mirror/mirrored_view.h"

namespace catoptric::planar_mirror {

void ProjectiveTexture::draw(raster::FrameContext& frame, const raster::Chain& chain,
                             const raster::PinholeView& mirrored,
                             const std::vector<raster::DrawRange>& ranges, const raster::Level& parent,
                             raster::Level& target) {
  // 1
  const int width = std::max(1, int(std::lround(frame.textureScale * chain.bounds.width)));
  const int height = std::max(1, int(std::lround(frame.textureScale * chain.bounds.height)));
  if (!texture_ || texture_->widthPx != width || texture_->heightPx != height)
    texture_ = std::make_unique<raster::Level>(width, height);
  texture_->withSeen = target.withSeen;
  texture_->isLast = target.isLast;
  const raster::PinholeView view =
      reduceToRectangle(mirrored, chain.bounds, target.widthPx, target.heightPx, width, height);
  frame.primary.draw(frame.scene, view, *texture_, chain.last, &ranges);

  // 2
  const auto drawMirror = [&](gl::Program& program) {
    gl::setScissor(chain.bounds);
    gl::setDrawState({.depthTest = false, .depthWrite = false});
    program.use();
    int unit = raster::kUnitFirstFree;
    const std::pair<const char*, const gl::Texture*> images[] = {
        {"u_parentIds", &parent.ids},        {"u_radiance", &texture_->radiance},
        {"u_position", &texture_->position}, {"u_weight", &texture_->weight},
        {"u_ids", &texture_->ids},           {"u_overlay", &texture_->overlay}};
    for (const auto& [name, image] : images) {
      image->bind(unit);
      program.set(name, unit++);
    }
    program.set("u_parentWord", chain.parentWord());
    program.set("u_chain", chain.id);
    program.set("u_bounds", vec4(chain.bounds.x, chain.bounds.y, chain.bounds.width, chain.bounds.height));
    nothing_.bind();
    gl::drawScreen();
  };
  target.surfaces.bind();
  drawMirror(program_);
  if (!texture_->hasOverlay) return;
  target.bindOverlay();
  drawMirror(overlayProgram_);
}

}  // namespace catoptric::planar_mirror
