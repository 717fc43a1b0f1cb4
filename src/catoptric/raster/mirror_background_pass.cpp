// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/reflection_method.h"

namespace catoptric::raster {

MirrorBackgroundPass::MirrorBackgroundPass()
    : program_("raster/screen.vert", "raster/mirror_background.frag") {}

void MirrorBackgroundPass::draw(const SceneBuffers& scene, const Chain& chain, const Level& parent,
                                const Level& target) {
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = true, .depthEqual = true, .depthWrite = false});
  program_.use();
  scene.bindEnvironment(program_);
  parent.bindAsParent(program_);
  program_.set("u_parentWord", chain.parentWord());
  program_.set("u_chain", chain.id);
  nothing_.bind();
  gl::drawScreen();
}

}  // namespace catoptric::raster
