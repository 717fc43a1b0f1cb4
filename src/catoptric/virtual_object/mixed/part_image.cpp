// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/part_image.h"

#include <array>

#include "catoptric/raster/surface_pass.h"

namespace catoptric::virtual_object {
namespace {

gl::Texture makeImage(gl::Format format, int width, int height) {
  return gl::Texture(gl::TextureKind::Flat, format, width, height, 1, 1, gl::SamplerState{});
}

}  // namespace

PartBuffers::PartBuffers(const ReflectorMesh& mesh, const CutMirror& cut)
    : positions_(gl::BufferKind::Vertex), indices_(gl::BufferKind::Index) {
  std::vector<vec3> positions;
  for (const dvec3& p : mesh.positions()) positions.emplace_back(p);
  std::vector<std::uint32_t> indices;
  for (const MirrorPart& part : cut.parts) {
    indices.insert(indices.end(), part.corners.begin(), part.corners.end());
    ends_.push_back(std::uint32_t(indices.size()));
  }
  indices.insert(indices.end(), cut.leftOut.begin(), cut.leftOut.end());
  ends_.push_back(std::uint32_t(indices.size()));
  positions_.upload(std::span<const vec3>(positions));
  indices_.upload(std::span<const std::uint32_t>(indices));
  array_.setAttribute(0, positions_, 3);
  array_.setIndices(indices_);
}

void PartBuffers::draw(gl::Program& program) const {
  array_.bind();
  std::uint32_t first = 0;
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    program.set("u_number", k + 1 < ends_.size() ? unsigned(k + 1) : 0u);
    if (ends_[k] > first) gl::drawTriangles(first, ends_[k] - first);
    first = ends_[k];
  }
}

PartImage::PartImage(int widthPx, int heightPx)
    : numbers_(makeImage(gl::Format::Rg32Ui, widthPx, heightPx)),
      depth_(makeImage(gl::Format::Depth32F, widthPx, heightPx)),
      done_(makeImage(gl::Format::Rg32Ui, widthPx, heightPx)),
      target_(std::array<const gl::Texture*, 1>{&numbers_}, &depth_) {}

void PartImage::drawParts(const PartBuffers& buffers, const mat4& clipFromDraw, const gl::Scissor& bounds) {
  target_.bind();
  gl::setScissor(bounds);
  target_.clearColor(0, uvec4(0u));
  target_.clearDepth();
  gl::setDrawState({});
  partProgram_.use();
  partProgram_.set("u_clipFromDraw", clipFromDraw);
  buffers.draw(partProgram_);
}

void PartImage::readParts(const gl::Scissor& bounds, std::vector<uvec2>& numbers) const {
  numbers.resize(std::size_t(bounds.width) * std::size_t(bounds.height));
  target_.readPixels(0, bounds, std::span<uvec2>(numbers));
}

void PartImage::setDone(const gl::Scissor& bounds, std::span<const std::uint8_t> isDone) {
  texels_.assign(isDone.size(), uvec2(0));
  for (std::size_t i = 0; i < isDone.size(); ++i) texels_[i].x = isDone[i];
  done_.uploadCorner(bounds.width, bounds.height, texels_.data());
}

void PartImage::closeDone(const gl::Scissor& bounds) {
  gl::setScissor(bounds);
  gl::setDrawState({.depthTest = true, .depthAlways = true, .depthWrite = true});
  maskProgram_.use();
  done_.bind(raster::kUnitFirstFree);
  maskProgram_.set("u_done", raster::kUnitFirstFree);
  maskProgram_.set("u_corner", vec2(float(bounds.x), float(bounds.y)));
  nothing_.bind();
  gl::drawScreen();
}

}  // namespace catoptric::virtual_object
