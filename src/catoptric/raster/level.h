// SPDX-License-Identifier: Apache-2.0
// The pictures of one level of mirrors: level 0 is the primary image, level k shows what is seen after k
// mirrors, at the pixels of level k-1's mirrors. Layout: shaders/raster/level_pixels.glsl.
// Composing adds what mirrors show to the radiance in place: pixels without a mirror are not touched again.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "catoptric/gl/framebuffer.h"
#include "catoptric/gl/program.h"
#include "catoptric/gl/texture.h"
#include "catoptric/raster/scene_buffers.h"

namespace catoptric::raster {

struct Level {
  Level(int widthPx, int heightPx, bool withStencil = false);

  /// Nothing is stored within `drawn` and a pixel around it, and nothing will be outside of it: what is there
  /// is left from other frames.
  void clear(const gl::Scissor& drawn);
  /// Only its depths: every pixel will be drawn.
  void clearDepths();
  /// What is drawn into where no mirror is.
  [[nodiscard]] const gl::Framebuffer& plainTarget() const {
    return withSeen ? plainSeen : withIds ? plain : plainRadiance;
  }
  /// Binds what blended surfaces are drawn into.
  void bindOverlay();
  /// Binds the stored pictures as the "parent" that the next level reads.
  void bindAsParent(gl::Program& program) const;

  int widthPx, heightPx;
  bool hasStencil;
  gl::Texture radiance, position, weight, ids, depth;
  gl::Texture overlay;                ///< blended surfaces, premultiplied
  gl::Texture seenPosition, seenIds;  ///< composed
  gl::Framebuffer surfaces;           ///< of mirrors: radiance, position, weight, ids
  gl::Framebuffer plain, plainSeen;   ///< of all else: radiance, ids; and position
  gl::Framebuffer plainRadiance;      ///< radiance alone
  gl::Framebuffer overlays;
  gl::Framebuffer composed;  ///< radiance
  gl::Framebuffer seen;      ///< seenPosition, seenIds
  bool withSeen = true;      ///< also says what is seen at each pixel ...
  bool composesSeen = true;  ///< ... and composes that
  /// Of the last level, if it need not say what is seen, and draws every pixel that shows a mirror: nobody
  /// asks for its ids.
  bool withIds = true;
  bool isLast = true;   ///< no level comes after it: its mirrors show the environment, and are shaded with it
  bool isDrawn = true;  ///< false: nothing of it is to be composed
  gl::Scissor drawnBounds;              ///< pixels that may show something
  std::vector<gl::Scissor> drawnRects;  ///< the same of a mirror's level, closer; empty: not known
  bool hasOverlay = false;
  int stencilValues = 0;  ///< given to mirrors so far
};

/// Blends a level with what its mirrors show, then blended surfaces over it, into its radiance; and what is
/// seen into its seenPosition and seenIds, if it says that (shaders/raster/compose.frag, overlay.frag,
/// seen.frag).
class ComposePass {
 public:
  ComposePass();
  /// `next`: composed; null for the last level.
  void draw(const Level& level, const Level* next);

 private:
  void addMirrored(const Level& level, const Level& next);
  void findSeen(const Level& level, const Level* next);

  gl::Program mirrored_, mirroredEverywhere_, overlay_;
  std::unique_ptr<gl::Program> seen_, seenLast_;  ///< made when first used
  gl::VertexArray nothing_;
};

}  // namespace catoptric::raster
