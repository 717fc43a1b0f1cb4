// SPDX-License-Identifier: Apache-2.0
// The pictures of one level of mirrors: level 0 is the primary image, level k shows what is seen after k
// mirrors, at the pixels of level k-1's mirrors. Layout: shaders/raster/level_pixels.glsl.
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

  /// Nothing is stored, and nothing will be outside of `drawn`.
  void clear(const gl::Scissor& drawn);
  void clear() { clear({0, 0, widthPx, heightPx}); }
  /// What is drawn into where no mirror is.
  [[nodiscard]] const gl::Framebuffer& plainTarget() const { return withSeen ? plainSeen : plain; }
  /// Binds what blended surfaces are drawn into.
  void bindOverlay();
  /// Binds the stored pictures as the "parent" that the next level reads.
  void bindAsParent(gl::Program& program) const;

  int widthPx, heightPx;
  bool hasStencil;
  gl::Texture radiance, position, weight, ids, depth;
  gl::Texture overlay;                       ///< blended surfaces, premultiplied
  gl::Texture color, seenPosition, seenIds;  ///< composed
  gl::Framebuffer surfaces;                  ///< of mirrors: radiance, position, weight, ids
  gl::Framebuffer plain, plainSeen;          ///< of all else: radiance, ids; and position
  gl::Framebuffer overlays;
  gl::Framebuffer composedColor, composed;  ///< color; and what is seen
  bool withSeen = true;                     ///< also says what is seen at each pixel
  gl::Scissor drawnBounds;                  ///< pixels that may show something
  bool hasOverlay = false;
  int stencilValues = 0;    ///< given to mirrors so far
  bool isComplete = false;  ///< something was drawn for every mirror pixel of the level before
};

/// Blends a level with what its mirrors show (shaders/raster/compose.frag).
class ComposePass {
 public:
  ComposePass();
  /// `next` may be null: mirrors show the environment.
  void draw(const SceneBuffers& scene, const Level& level, const Level* next);

 private:
  enum Feature : unsigned { kNext = 1, kEnvironment = 2, kOverlay = 4, kSeen = 8 };
  [[nodiscard]] gl::Program& findProgram(unsigned features);

  std::array<std::unique_ptr<gl::Program>, 16> programs_;  ///< by features, made when first used
  gl::VertexArray nothing_;
};

}  // namespace catoptric::raster
