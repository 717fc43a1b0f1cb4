// SPDX-License-Identifier: Apache-2.0
// Vertices of the world, or of its finer pieces, on the GPU. Attribute locations as in
// shaders/raster/surface.vert.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/buffer.h"

namespace catoptric::raster {

/// Triangles of one part, in the index buffer that is bound.
struct DrawRange {
  std::uint32_t part = 0;
  std::uint32_t firstIndex = 0, indexCount = 0;
};

class VertexStreams {
 public:
  /// `World` is scene::WorldGeometry or anything with the same arrays.
  template <class World>
  explicit VertexStreams(const World& world) : VertexStreams() {
    upload(0, world.positions, 3);
    upload(1, world.normals, 3);
    upload(2, world.tangents, 4);
    upload(3, world.uv0, 2);
    upload(4, world.uv1, 2);
    upload(5, world.colors, 4);
    array_.setAttribute(6, buffers_[0], 3);  // drawn where they are, until setDrawPositions()
    setIndices(world.indices, false);
  }

  /// Positions, normals and tangents of some vertices, after they have moved.
  template <class World>
  void update(const World& world, std::size_t firstVertex, std::size_t count) {
    updateRange(0, world.positions, firstVertex, count);
    updateRange(1, world.normals, firstVertex, count);
    updateRange(2, world.tangents, firstVertex, count);
  }

  /// Virtual vertices, one per vertex.
  void setDrawPositions(std::span<const vec3> positions);
  void setIndices(std::span<const std::uint32_t> indices, bool changesEveryFrame);
  void bind() const { array_.bind(); }

 private:
  VertexStreams();
  template <class T>
  void upload(unsigned location, const std::vector<T>& values, int components) {
    buffers_[location].upload(std::span<const T>(values));
    array_.setAttribute(location, buffers_[location], components);
  }

  template <class T>
  void updateRange(unsigned location, const std::vector<T>& values, std::size_t first, std::size_t count) {
    buffers_[location].uploadRange(first * sizeof(T),
                                   std::as_bytes(std::span<const T>(values).subspan(first, count)));
  }

  gl::Buffer buffers_[6];
  gl::Buffer drawPositions_, indices_;
  gl::VertexArray array_;
};

}  // namespace catoptric::raster
