// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/mirror_mask.h"

namespace catoptric::raster {

constexpr int kMostStencilValues = 255;

Masking MirrorMask::begin(Merge merge, const Chain& chain, const Level& parent, Level& target) {
  const bool usesStencil = merge == Merge::Stencil || merge == Merge::Erase;
  const bool hasValue = target.hasStencil && target.stencilValues < kMostStencilValues;
  merge_ = (usesStencil && hasValue) || merge == Merge::Depth ? merge : Merge::Ids;
  if (merge_ == Merge::Ids) return {};
  target.surfaces.bind();
  if (merge_ == Merge::Depth) {
    maskDepth(chain, parent);
    return {.testsIds = false};
  }
  value_ = std::uint8_t(++target.stencilValues);
  if (merge_ == Merge::Stencil) markStencil(chain, parent);
  // What is to be erased is drawn wherever no mirror has been drawn yet.
  const std::uint8_t drawnWhere = merge_ == Merge::Erase ? 0 : value_;
  return {.testsIds = false, .stencil = gl::StencilRule::WhereEqual, .stencilValue = drawnWhere};
}

void MirrorMask::end(const Chain& chain, const Level& parent, Level& target) {
  if (merge_ != Merge::Erase) return;
  target.surfaces.bind();
  markStencil(chain, parent);
  erase(chain, target);
}

void MirrorMask::markStencil(const Chain& chain, const Level& parent) {
  if (!stencil_) stencil_ = std::make_unique<gl::Program>("raster/screen.vert", "raster/mirror_mask.frag");
  drawMask(*stencil_, chain, parent,
           {.depthTest = false,
            .depthWrite = false,
            .colorWrite = false,
            .stencil = gl::StencilRule::Write,
            .stencilValue = value_});
}

void MirrorMask::maskDepth(const Chain& chain, const Level& parent) {
  if (!depth_)
    depth_ = std::make_unique<gl::Program>("raster/screen.vert", "raster/mirror_mask.frag",
                                           std::vector<std::string>{"DEPTH"});
  drawMask(*depth_, chain, parent, {.depthAlways = true, .colorWrite = false});
}

void MirrorMask::drawMask(gl::Program& program, const Chain& chain, const Level& parent,
                          const gl::DrawState& state) {
  gl::setScissor(chain.bounds);
  gl::setDrawState(state);
  program.use();
  parent.bindAsParent(program);
  program.set("u_parentWord", chain.parentWord());
  nothing_.bind();
  gl::drawScreen();
}

void MirrorMask::erase(const Chain& chain, Level& target) {
  if (!erase_) erase_ = std::make_unique<gl::Program>("raster/screen.vert", "raster/erase.frag");
  erase_->use();
  nothing_.bind();
  const auto draw = [&] {
    gl::setScissor(chain.bounds);
    gl::setDrawState({.depthAlways = true, .stencil = gl::StencilRule::WhereEqual, .stencilValue = 0});
    gl::drawScreen();
  };
  draw();
  if (!target.hasOverlay) return;
  target.bindOverlay();
  draw();
}

}  // namespace catoptric::raster
