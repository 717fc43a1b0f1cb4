// SPDX-License-Identifier: Apache-2.0
// Buffers and vertex arrays.
#pragma once

#include <cstddef>
#include <span>

namespace catoptric::gl {

enum class BufferKind { Vertex, Index, Uniform };

class Buffer {
 public:
  explicit Buffer(BufferKind kind);
  ~Buffer();
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  /// Replaces the contents; keeps the storage when it is large enough.
  void upload(std::span<const std::byte> bytes, bool changesEveryFrame = false);
  template <class T>
  void upload(std::span<const T> values, bool changesEveryFrame = false) {
    upload(std::as_bytes(values), changesEveryFrame);
  }
  /// Replaces a part of the contents, which must be there already.
  void uploadRange(std::size_t offset, std::span<const std::byte> bytes);
  /// Uniform buffers: makes a range visible at a binding point.
  void bindRange(unsigned bindingPoint, std::size_t offset, std::size_t size) const;

  [[nodiscard]] unsigned id() const { return id_; }

 private:
  unsigned id_ = 0, target_ = 0;
  std::size_t capacity_ = 0;
};

/// Offsets of uniform buffer ranges must be multiples of this.
[[nodiscard]] std::size_t uniformBufferAlignment();

/// Which buffer feeds which vertex attribute (tightly packed).
class VertexArray {
 public:
  VertexArray();
  ~VertexArray();
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;

  void setAttribute(unsigned location, const Buffer& buffer, int components);  ///< floats
  void setUnsignedAttribute(unsigned location, const Buffer& buffer);          ///< one 32-bit integer each
  void setIndices(const Buffer& buffer);
  void bind() const;

 private:
  unsigned id_ = 0;
};

}  // namespace catoptric::gl
