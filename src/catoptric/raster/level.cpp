// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/level.h"

#include <array>
#include <span>

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
      seenPosition(makeTarget(gl::Format::Rgba32F, width, height)),
      seenIds(makeTarget(gl::Format::Rg32Ui, width, height)),
      surfaces(makeFramebuffer({&radiance, &position, &weight, &ids}, &depth)),
      plain(makeFramebuffer({&radiance, &ids}, &depth)),
      plainSeen(makeFramebuffer({&radiance, &ids, &position}, &depth)),
      plainRadiance(makeFramebuffer({&radiance}, &depth)),
      overlays(makeFramebuffer({&overlay}, &depth)),
      composed(makeFramebuffer({&radiance}, nullptr)),
      seen(makeFramebuffer({&seenPosition, &seenIds}, nullptr)) {}

void Level::clear(const gl::Scissor& drawn) {
  drawnBounds = drawn;
  hasOverlay = false;
  surfaces.bind();
  // Neighbours of what is drawn are looked at, too: are they of the same mirror?
  gl::setScissor({drawn.x - 1, drawn.y - 1, drawn.width + 2, drawn.height + 2});
  // Where ids say that there is nothing, the other three are never looked at.
  if (withIds || withSeen) surfaces.clearColor(3, uvec4(0u));
  surfaces.clearDepth();
  stencilValues = 0;
  if (hasStencil) surfaces.clearStencil();
}

void Level::clearDepths() {
  drawnBounds = {0, 0, widthPx, heightPx};
  hasOverlay = false;
  plain.bind();
  plain.clearDepth();
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

ComposePass::ComposePass()
    : mirrored_("raster/screen.vert", "raster/compose.frag"),
      mirroredEverywhere_("raster/screen.vert", "raster/compose.frag", {"EVERYWHERE"}),
      overlay_("raster/screen.vert", "raster/overlay.frag") {}

namespace {

void bindImages(gl::Program& program,
                std::initializer_list<std::pair<const char*, const gl::Texture*>> images) {
  int unit = kUnitFirstFree;
  for (const auto& [name, texture] : images) {
    texture->bind(unit);
    program.set(name, unit++);
  }
}

}  // namespace

void ComposePass::addMirrored(const Level& level, const Level& next) {
  level.composed.bind();
  gl::setDrawState({.depthTest = false, .depthWrite = false, .blend = gl::Blend::Add});
  gl::Program& program = next.withIds || next.withSeen ? mirrored_ : mirroredEverywhere_;
  program.use();
  bindImages(program, {{"u_ids", &level.ids},
                       {"u_weight", &level.weight},
                       {"u_nextIds", &next.ids},
                       {"u_nextRadiance", &next.radiance}});
  const std::span<const gl::Scissor> rects =
      next.drawnRects.empty() ? std::span(&next.drawnBounds, 1) : std::span(next.drawnRects);
  for (const gl::Scissor& rect : rects) {
    gl::setScissor(rect);
    gl::drawScreen();
  }
}

void ComposePass::findSeen(const Level& level, const Level* next) {
  std::unique_ptr<gl::Program>& program = next ? seen_ : seenLast_;
  if (!program)
    program =
        std::make_unique<gl::Program>("raster/screen.vert", "raster/seen.frag",
                                      next ? std::vector<std::string>{"NEXT"} : std::vector<std::string>{});
  level.seen.bind();
  gl::setScissor(level.drawnBounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  program->use();
  bindImages(*program, {{"u_position", &level.position}, {"u_ids", &level.ids}});
  if (next) {
    const gl::Scissor& b = next->drawnBounds;
    program->set("u_nextBounds", vec4(b.x, b.y, b.x + b.width, b.y + b.height));
    bindImages(*program, {{"u_position", &level.position},
                          {"u_ids", &level.ids},
                          {"u_nextIds", &next->ids},
                          {"u_nextSeenPosition", &next->seenPosition},
                          {"u_nextSeenIds", &next->seenIds}});
  }
  gl::drawScreen();
}

void ComposePass::draw(const Level& level, const Level* next) {
  nothing_.bind();
  if (next && next->isDrawn) addMirrored(level, *next);
  if (level.hasOverlay) {
    level.composed.bind();
    gl::setScissor(level.drawnBounds);
    gl::setDrawState({.depthTest = false, .depthWrite = false, .blend = gl::Blend::Premultiplied});
    overlay_.use();
    bindImages(overlay_, {{"u_overlay", &level.overlay}});
    gl::drawScreen();
  }
  if (level.withSeen && level.composesSeen) findSeen(level, next);
}

}  // namespace catoptric::raster
