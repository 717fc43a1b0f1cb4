// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/level.h"

#include <array>

namespace catoptric::raster {
namespace {

gl::Texture makeTarget(gl::Format format, int widthPx, int heightPx) {
  return gl::Texture(gl::TextureKind::Flat, format, widthPx, heightPx, 1, 1, gl::SamplerState{});
}

gl::Framebuffer makeFramebuffer(std::initializer_list<const gl::Texture*> colors, const gl::Texture* depth) {
  return gl::Framebuffer(std::span(colors.begin(), colors.size()), depth);
}

}  // namespace

Level::Level(int width, int height, bool withStencil)
    : widthPx(width),
      heightPx(height),
      hasStencil(withStencil),
      radiance(makeTarget(gl::Format::Rgba32F, width, height)),
      position(makeTarget(gl::Format::Rgba32F, width, height)),
      weight(makeTarget(gl::Format::Rgba32F, width, height)),
      ids(makeTarget(gl::Format::Rg32Ui, width, height)),
      depth(makeTarget(withStencil ? gl::Format::Depth32FStencil8 : gl::Format::Depth32F, width, height)),
      overlay(makeTarget(gl::Format::Rgba32F, width, height)),
      color(makeTarget(gl::Format::Rgba32F, width, height)),
      seenPosition(makeTarget(gl::Format::Rgba32F, width, height)),
      seenIds(makeTarget(gl::Format::Rg32Ui, width, height)),
      surfaces(makeFramebuffer({&radiance, &position, &weight, &ids}, &depth)),
      plain(makeFramebuffer({&radiance, &ids}, &depth)),
      plainSeen(makeFramebuffer({&radiance, &ids, &position}, &depth)),
      overlays(makeFramebuffer({&overlay}, &depth)),
      composedColor(makeFramebuffer({&color}, nullptr)),
      composed(makeFramebuffer({&color, &seenPosition, &seenIds}, nullptr)) {}

void Level::clear(const gl::Scissor& drawn) {
  drawnBounds = drawn;
  hasOverlay = isComplete = false;
  surfaces.bind();
  surfaces.clearColor(3,
                      uvec4(0u));  // where ids say that there is nothing, the other three are never looked at
  surfaces.clearDepth();
  stencilValues = 0;
  if (hasStencil) surfaces.clearStencil();
}

void Level::bindOverlay() {
  overlays.bind();
  if (!hasOverlay) overlays.clearColor(0, vec4(0.0f));
  hasOverlay = true;
}

void Level::bindAsParent(gl::Program& program) const {
  const std::array<std::pair<const char*, const gl::Texture*>, 4> images{{{"u_parentRadiance", &radiance},
                                                                          {"u_parentPosition", &position},
                                                                          {"u_parentWeight", &weight},
                                                                          {"u_parentIds", &ids}}};
  int unit = kUnitFirstFree;
  for (const auto& [name, texture] : images) {
    texture->bind(unit);
    program.set(name, unit++);
  }
}

ComposePass::ComposePass() = default;

gl::Program& ComposePass::findProgram(unsigned features) {
  std::unique_ptr<gl::Program>& program = programs_[features];
  if (program) return *program;
  std::vector<std::string> defines;
  if ((features & kNext) != 0) defines.emplace_back("NEXT");
  if ((features & kEnvironment) != 0) defines.emplace_back("ENVIRONMENT");
  if ((features & kOverlay) != 0) defines.emplace_back("OVERLAY");
  if ((features & kSeen) != 0) defines.emplace_back("SEEN");
  program = std::make_unique<gl::Program>("raster/screen.vert", "raster/compose.frag", defines);
  return *program;
}

void ComposePass::draw(const SceneBuffers& scene, const Level& level, const Level* next) {
  (level.withSeen ? level.composed : level.composedColor).bind();
  gl::setScissor(level.drawnBounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  const bool showsEnvironment = next == nullptr || !next->isComplete;
  gl::Program& program = findProgram((next ? kNext : 0u) | (showsEnvironment ? kEnvironment : 0u) |
                                     (level.hasOverlay ? kOverlay : 0u) | (level.withSeen ? kSeen : 0u));
  program.use();
  scene.bindEnvironment(program);
  const Level& other = next ? *next : level;
  int unit = kUnitFirstFree;
  const auto bind = [&](const char* name, const gl::Texture& texture) {
    texture.bind(unit);
    program.set(name, unit++);
  };
  bind("u_radiance", level.radiance);
  bind("u_position", level.position);
  bind("u_weight", level.weight);
  bind("u_ids", level.ids);
  bind("u_overlay", level.overlay);
  bind("u_nextIds", other.ids);
  // Without a next level these are never read; a target that is being written must not be bound.
  bind("u_nextColor", next ? next->color : level.radiance);
  bind("u_nextSeenPosition", next ? next->seenPosition : level.position);
  bind("u_nextSeenIds", next ? next->seenIds : level.ids);
  nothing_.bind();
  gl::drawScreen();
}

}  // namespace catoptric::raster
