// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/reflection_method.h"

namespace catoptric::raster {

constexpr std::uint32_t kUnfollowedBit = 0x20000000u;  // shaders/raster/level_pixels.glsl

MirrorBackgroundPass::MirrorBackgroundPass()
    : program_("raster/screen.vert", "raster/mirror_background.frag"),
      programSeen_("raster/screen.vert", "raster/mirror_background.frag", {"SEEN"}) {}

void MirrorBackgroundPass::draw(const SceneBuffers& scene, const Chain& chain, const Level& parent,
                                const Level& target, bool isFollowed, std::span<const gl::Scissor> rects) {
  target.plainTarget().bind();
  gl::setDrawState({.depthTest = true, .depthEqual = true, .depthWrite = false});
  gl::Program& program = target.withSeen ? programSeen_ : program_;
  program.use();
  scene.bindEnvironment(program);
  parent.bindAsParent(program);
  program.set("u_parentWord", chain.parentWord());
  program.set("u_chain", chain.id);
  program.set("u_objectWord", isFollowed ? 0u : kUnfollowedBit);
  nothing_.bind();
  if (rects.empty()) rects = {&chain.bounds, 1};
  for (const gl::Scissor& rect : rects) {
    gl::setScissor(rect);
    gl::drawScreen();
  }
}

}  // namespace catoptric::raster
