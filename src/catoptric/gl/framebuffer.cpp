// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/framebuffer.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "catoptric/core/error.h"
#include "catoptric/gl/buffer.h"

namespace catoptric::gl {

Framebuffer::Framebuffer(std::span<const Texture* const> colors, const Texture* depth) {
  glGenFramebuffers(1, &id_);
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  std::vector<GLenum> drawBuffers;
  for (const Texture* color : colors) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + unsigned(drawBuffers.size());
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, color->id(), 0);
    drawBuffers.push_back(attachment);
    width_ = color->width();
    height_ = color->height();
  }
  if (depth)
    glFramebufferTexture2D(
        GL_FRAMEBUFFER,
        depth->format() == Format::Depth32FStencil8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
        GL_TEXTURE_2D, depth->id(), 0);
  glDrawBuffers(GLsizei(drawBuffers.size()), drawBuffers.data());
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    glDeleteFramebuffers(1, &id_);
    throw core::Error(
        "gl.framebuffer",
        fmt::format("a {}x{} render target is not supported (0x{:04x})", width_, height_, status), {},
        "use a smaller --size or --method raytrace");
  }
}

Framebuffer::~Framebuffer() {
  glDeleteFramebuffers(1, &id_);
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glViewport(0, 0, width_, height_);
  glDisable(GL_SCISSOR_TEST);
}

void Framebuffer::clearColor(int attachment, const vec4& value) const {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearBufferfv(GL_COLOR, attachment, &value[0]);
}

void Framebuffer::clearColor(int attachment, const uvec4& value) const {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearBufferuiv(GL_COLOR, attachment, &value[0]);
}

void Framebuffer::clearDepth() const {
  const float one = 1.0f;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_DEPTH, 0, &one);
}

void Framebuffer::clearStencil() const {
  const GLint zero = 0;
  glStencilMask(0xff);
  glClearBufferiv(GL_STENCIL, 0, &zero);
}

void Framebuffer::readPixels(int attachment, std::span<vec4> out) const {
  readPixels(attachment, {0, 0, width_, height_}, out);
}

void Framebuffer::readPixels(int attachment, std::span<uvec2> out) const {
  readPixels(attachment, {0, 0, width_, height_}, out);
}

void Framebuffer::readPixels(int attachment, const Scissor& pixels, std::span<uvec2> out) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id_);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + unsigned(attachment));
  glReadPixels(pixels.x, pixels.y, pixels.width, pixels.height, GL_RG_INTEGER, GL_UNSIGNED_INT, out.data());
}

void Framebuffer::readPixels(int attachment, const Scissor& pixels, std::span<vec4> out) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id_);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + unsigned(attachment));
  glReadPixels(pixels.x, pixels.y, pixels.width, pixels.height, GL_RGBA, GL_FLOAT, out.data());
}

template <class Pixel>
void Framebuffer::readPixelsInPlace(int attachment, const Scissor& pixels, std::span<Pixel> out) const {
  glPixelStorei(GL_PACK_ROW_LENGTH, width_);
  const std::size_t first = std::size_t(pixels.y) * std::size_t(width_) + std::size_t(pixels.x);
  readPixels(attachment, pixels, out.subspan(first));
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

template void Framebuffer::readPixelsInPlace(int, const Scissor&, std::span<uvec2>) const;
template void Framebuffer::readPixelsInPlace(int, const Scissor&, std::span<vec4>) const;

void Framebuffer::copyToCubeFace(int attachment, const Texture& cube, int face) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id_);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + unsigned(attachment));
  glBindTexture(GL_TEXTURE_CUBE_MAP, cube.id());
  glCopyTexSubImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + unsigned(face), 0, 0, 0, 0, 0, width_, height_);
}

namespace {

void setStencil(StencilRule rule, GLint value) {
  if (rule == StencilRule::None) {
    glDisable(GL_STENCIL_TEST);
    return;
  }
  const bool writes = rule == StencilRule::Write;
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(writes ? GL_ALWAYS : GL_EQUAL, value, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, writes ? GL_REPLACE : GL_KEEP);
  glStencilMask(writes ? 0xff : 0);
}

}  // namespace

void setDrawState(const DrawState& state) {
  const GLboolean color = state.colorWrite ? GL_TRUE : GL_FALSE;
  glColorMask(color, color, color, color);
  setStencil(state.stencil, state.stencilValue);
  for (int i = 0; i < kMostClipDistances; ++i)
    (i < state.clipDistances ? glEnable : glDisable)(GL_CLIP_DISTANCE0 + unsigned(i));
  if (state.depthTest) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(state.depthAlways ? GL_ALWAYS : state.depthEqual ? GL_LEQUAL : GL_LESS);
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  glDepthMask(state.depthWrite ? GL_TRUE : GL_FALSE);
  if (state.cull == Cull::None) {
    glDisable(GL_CULL_FACE);
  } else {
    glEnable(GL_CULL_FACE);
    glCullFace(state.cull == Cull::Back ? GL_BACK : GL_FRONT);
  }
  if (state.blend == Blend::None) {
    glDisable(GL_BLEND);
  } else {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, state.blend == Blend::Add ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
  }
}

void setScissor(const Scissor& scissor) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(scissor.x, scissor.y, scissor.width, scissor.height);
}

void drawTriangles(std::uint32_t firstIndex, std::uint32_t indexCount) {
  glDrawElements(GL_TRIANGLES, GLsizei(indexCount), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(std::uintptr_t(firstIndex) * sizeof(std::uint32_t)));
}

void drawLines(std::uint32_t vertexCount) {
  glDrawArrays(GL_LINES, 0, GLsizei(vertexCount));
}

void drawPoints(std::uint32_t vertexCount) {
  glDrawArrays(GL_POINTS, 0, GLsizei(vertexCount));
}

void drawScreen() {
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace catoptric::gl
