// SPDX-License-Identifier: Apache-2.0
// Images that keep the virtual object of each part of a mirror within that part's pixels, and solver `exact`
// within what is left.
//
// Steps: 1 the mirror's parts drawn as numbers, the nearest one kept; 2 which pixels are done, from the
// processor: they are closed by a depth before everything.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/gl/buffer.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/gl/program.h"
#include "catoptric/virtual_object/mixed/mirror_parts.h"

namespace catoptric::virtual_object {

/// Triangles of a mirror's parts, one part after another.
class PartBuffers {
 public:
  PartBuffers(const ReflectorMesh& mesh, const CutMirror& cut);
  /// Part k is drawn as k + 1, with the program of mirror_part.frag in use; what belongs to none as 0.
  void draw(gl::Program& program) const;

 private:
  gl::Buffer positions_, indices_;
  gl::VertexArray array_;
  std::vector<std::uint32_t> ends_;  ///< of the parts' indices
};

class PartImage {
 public:
  PartImage(int widthPx, int heightPx);
  [[nodiscard]] bool fits(int widthPx, int heightPx) const {
    return numbers_.width() == widthPx && numbers_.height() == heightPx;
  }

  /// Step 1 within `bounds`. `clipFromDraw`: where the mirror's triangles stand on the screen.
  void drawParts(const PartBuffers& buffers, const mat4& clipFromDraw, const gl::Scissor& bounds);
  /// Number of the part at each pixel of `bounds`, row by row, and 0.
  void readParts(const gl::Scissor& bounds, std::vector<uvec2>& numbers) const;

  /// Step 2: `isDone` by pixel of `bounds`.
  void setDone(const gl::Scissor& bounds, std::span<const std::uint8_t> isDone);
  /// Into the bound target of hits: nothing can be drawn where pixels are done.
  void closeDone(const gl::Scissor& bounds);

 private:
  gl::Texture numbers_, depth_, done_;
  gl::Framebuffer target_;
  gl::Program partProgram_{"virtual_object/mirror_part.vert", "virtual_object/mirror_part.frag"};
  gl::Program maskProgram_{"raster/screen.vert", "virtual_object/done_mask.frag"};
  gl::VertexArray nothing_;
  std::vector<uvec2> texels_;
};

}  // namespace catoptric::virtual_object
