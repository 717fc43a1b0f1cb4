// SPDX-License-Identifier: Apache-2.0
// Render targets and draw calls.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/texture.h"

namespace catoptric::gl {

/// Rectangle in pixels, origin at the lower left corner.
struct Scissor {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Attaches textures it does not own.
class Framebuffer {
 public:
  /// All of one size. `depth` may be null. Throws core::Error("gl.framebuffer") if incomplete.
  Framebuffer(std::span<const Texture* const> colors, const Texture* depth);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  void bind() const;  ///< also sets the viewport to the whole target and turns the scissor off
  void clearColor(int attachment, const vec4& value) const;
  void clearColor(int attachment, const uvec4& value) const;
  void clearDepth() const;
  void clearStencil() const;  ///< to 0; `depth` must have a stencil

  /// Reads an attachment, bottom row first, into 4 floats or 2 unsigned integers per pixel.
  void readPixels(int attachment, std::span<vec4> out) const;
  void readPixels(int attachment, std::span<uvec2> out) const;

  /// The same for some pixels, row by row.
  void readPixels(int attachment, const Scissor& pixels, std::span<vec4> out) const;
  void readPixels(int attachment, const Scissor& pixels, std::span<uvec2> out) const;
  /// The same, each pixel to where it would be if all were read; others are left as they are.
  /// Pixel: vec4 or uvec2.
  template <class Pixel>
  void readPixelsInPlace(int attachment, const Scissor& pixels, std::span<Pixel> out) const;

  /// Copies a colour attachment into level 0 of a face of a cube texture of the same size and format.
  void copyToCubeFace(int attachment, const Texture& cube, int face) const;

 private:
  unsigned id_ = 0;
  int width_ = 0, height_ = 0;
};

enum class Cull : std::uint8_t { None, Back, Front };

constexpr int kMostClipDistances = 8;  ///< that every OpenGL 3.3 has

enum class StencilRule : std::uint8_t {
  None,        ///< drawn whatever the stencil says
  WhereEqual,  ///< drawn where it has the value
  Write        ///< the value is stored wherever something is drawn
};

enum class Blend : std::uint8_t {
  None,
  Premultiplied,  ///< source + destination * (1 - source alpha)
  Add             ///< source + destination
};

struct DrawState {
  bool depthTest = true;     ///< drawn where nothing nearer is
  bool depthEqual = false;   ///< nor anything as near
  bool depthAlways = false;  ///< drawn, and its depth stored, whatever is there
  bool depthWrite = true;
  bool colorWrite = true;
  StencilRule stencil = StencilRule::None;
  std::uint8_t stencilValue = 0;
  int clipDistances = 0;  ///< of gl_ClipDistance[], the first so many count; none under OpenGL ES
  Cull cull = Cull::None;
  Blend blend = Blend::None;
};

void setDrawState(const DrawState& state);
void setScissor(const Scissor& scissor);
/// The bound vertex array's index buffer, 32-bit indices, triangles.
void drawTriangles(std::uint32_t firstIndex, std::uint32_t indexCount);
/// The vertices of the bound array in order: two for each line, one for each point.
void drawLines(std::uint32_t vertexCount);
void drawPoints(std::uint32_t vertexCount);
/// One triangle that covers the target, farther than all else; shaders/raster/screen.vert makes its corners
/// from gl_VertexID.
void drawScreen();

}  // namespace catoptric::gl
