// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/buffer.h"

#include <glad/gl.h>

#include <cassert>

namespace catoptric::gl {

Buffer::Buffer(BufferKind kind)
    : target_(kind == BufferKind::Vertex  ? GL_ARRAY_BUFFER
              : kind == BufferKind::Index ? GL_ELEMENT_ARRAY_BUFFER
                                          : GL_UNIFORM_BUFFER) {
  glGenBuffers(1, &id_);
}

Buffer::~Buffer() {
  glDeleteBuffers(1, &id_);
}

void Buffer::upload(std::span<const std::byte> bytes, bool changesEveryFrame) {
  // The copy-write target leaves vertex array state alone (an index buffer binding belongs to the vertex
  // array).
  glBindBuffer(GL_COPY_WRITE_BUFFER, id_);
  if (bytes.size() > capacity_ || capacity_ == 0) {
    glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr(bytes.size()), bytes.data(),
                 changesEveryFrame ? GL_STREAM_DRAW : GL_STATIC_DRAW);
    capacity_ = bytes.size();
  } else {
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0, GLsizeiptr(bytes.size()), bytes.data());
  }
}

void Buffer::uploadRange(std::size_t offset, std::span<const std::byte> bytes) {
  assert(offset + bytes.size() <= capacity_);
  if (bytes.empty()) return;
  glBindBuffer(GL_COPY_WRITE_BUFFER, id_);
  glBufferSubData(GL_COPY_WRITE_BUFFER, GLintptr(offset), GLsizeiptr(bytes.size()), bytes.data());
}

void Buffer::bindRange(unsigned bindingPoint, std::size_t offset, std::size_t size) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, bindingPoint, id_, GLintptr(offset), GLsizeiptr(size));
}

std::size_t uniformBufferAlignment() {
  GLint alignment = 256;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  return std::size_t(alignment);
}

VertexArray::VertexArray() {
  glGenVertexArrays(1, &id_);
}

VertexArray::~VertexArray() {
  glDeleteVertexArrays(1, &id_);
}

void VertexArray::setAttribute(unsigned location, const Buffer& buffer, int components) {
  glBindVertexArray(id_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void VertexArray::setUnsignedAttribute(unsigned location, const Buffer& buffer) {
  glBindVertexArray(id_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glEnableVertexAttribArray(location);
  glVertexAttribIPointer(location, 1, GL_UNSIGNED_INT, 0, nullptr);
}

void VertexArray::setIndices(const Buffer& buffer) {
  glBindVertexArray(id_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
}

void VertexArray::bind() const {
  glBindVertexArray(id_);
}

}  // namespace catoptric::gl
