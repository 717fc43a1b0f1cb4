// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/vertex_streams.h"

namespace catoptric::raster {

using gl::BufferKind;

VertexStreams::VertexStreams()
    : buffers_{gl::Buffer(BufferKind::Vertex), gl::Buffer(BufferKind::Vertex),
               gl::Buffer(BufferKind::Vertex), gl::Buffer(BufferKind::Vertex),
               gl::Buffer(BufferKind::Vertex), gl::Buffer(BufferKind::Vertex)},
      drawPositions_(BufferKind::Vertex),
      indices_(BufferKind::Index) {
  array_.setIndices(indices_);
}

void VertexStreams::setDrawPositions(std::span<const vec3> positions) {
  drawPositions_.upload(positions, true);
  array_.setAttribute(6, drawPositions_, 3);
}

void VertexStreams::setIndices(std::span<const std::uint32_t> indices, bool changesEveryFrame) {
  indices_.upload(indices, changesEveryFrame);
}

}  // namespace catoptric::raster
