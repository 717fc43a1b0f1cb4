// SPDX-License-Identifier: Apache-2.0
// Buffers, buffer views, accessors: every range is checked before anything is read. Integers of the file are
// at most 2^53 (element.h) and a stride is at most 252, so that offset + stride * count cannot wrap in 64
// bits.
#include <fmt/format.h>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

void readBufferView(const Element& element, Model& model) {
  BufferView view;
  view.buffer = element.getIndex("buffer", model.buffers.size(), "buffer");
  view.byteOffset = element.findInteger("byteOffset", 0);
  view.byteLength = element.getInteger("byteLength", 1);
  view.byteStride = element.findInteger("byteStride", 0, 4, 252);
  if (view.byteStride % 4 != 0)
    element.find("byteStride")
        ->fail("gltf.accessor_stride", fmt::format("the stride {} is not a multiple of 4", view.byteStride));
  const std::size_t available = model.buffers[std::size_t(view.buffer)].byteLength;
  if (view.byteOffset + view.byteLength > available)
    element.fail("gltf.accessor_range",
                 fmt::format("buffer view reaches byte {} of a buffer that holds {}",
                             view.byteOffset + view.byteLength, available),
                 "the file is damaged or was cut short");
  if (view.byteStride > view.byteLength)
    element.fail("gltf.accessor_stride", fmt::format("the stride {} is larger than the buffer view, {} bytes",
                                                     view.byteStride, view.byteLength));
  model.bufferViews.push_back(view);
}

ComponentType readComponentType(const Element& element) {
  const std::size_t value = element.getInteger("componentType");
  switch (value) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
      return ComponentType(value);
    default:
      element.find("componentType")->fail("gltf.value", fmt::format("{} is no component type", value));
  }
}

ElementType readElementType(const Element& element) {
  constexpr std::array kNames = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  const std::string name = element.getString("type");
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i]) return ElementType(i);
  element.find("type")->fail("gltf.value", fmt::format("\"{}\" is no accessor type", printable(name)));
}

/// Throws unless `count` elements of `bytes` at `offset` lie inside the view and are aligned to `alignment`.
void checkRange(const Element& element, const BufferView& view, std::size_t offset, std::size_t count,
                std::size_t bytes, std::size_t alignment) {
  const std::size_t stride = view.byteStride != 0 ? view.byteStride : bytes;
  if (stride < bytes)
    element.fail("gltf.accessor_stride",
                 fmt::format("an element has {} bytes but the buffer view's stride is {}", bytes, stride));
  if (offset % alignment != 0 || (offset + view.byteOffset) % alignment != 0)
    element.fail("gltf.accessor_alignment",
                 fmt::format("data at byte {} of the buffer is not aligned to {} bytes",
                             offset + view.byteOffset, alignment));
  std::size_t end = 0;
  const bool wraps =
      __builtin_mul_overflow(stride, count - 1, &end) || __builtin_add_overflow(end, offset + bytes, &end);
  if (wraps || end > view.byteLength)
    element.fail(
        "gltf.accessor_range",
        wraps ? fmt::format("accessor reaches far beyond a buffer view that holds {} bytes", view.byteLength)
              : fmt::format("accessor reaches byte {} of a buffer view that holds {}", end, view.byteLength),
        "the file is damaged or was cut short");
}

/// Sparse parts are tightly packed: a stride other than the element's size is ambiguous.
void checkTight(const Element& element, const BufferView& view, std::size_t bytes) {
  if (view.byteStride != 0 && view.byteStride != bytes)
    element.fail("gltf.accessor_stride", "sparse data must not lie in a buffer view with a stride");
}

SparseValues readSparse(const Element& element, const Model& model, const Accessor& accessor) {
  SparseValues sparse;
  sparse.count = element.getInteger("count", 1);
  if (sparse.count > accessor.count)
    element.find("count")->fail(
        "gltf.value",
        fmt::format("{} sparse elements replace those of an accessor with {}", sparse.count, accessor.count));
  const Element indices = element.getObject("indices"), values = element.getObject("values");
  sparse.indexView = indices.getIndex("bufferView", model.bufferViews.size(), "buffer view");
  sparse.indexOffset = indices.findInteger("byteOffset", 0);
  sparse.indexType = readComponentType(indices);
  if (sparse.indexType != ComponentType::Uint8 && sparse.indexType != ComponentType::Uint16 &&
      sparse.indexType != ComponentType::Uint32)
    indices.find("componentType")->fail("gltf.accessor_format", "sparse indices must be unsigned integers");
  sparse.valueView = values.getIndex("bufferView", model.bufferViews.size(), "buffer view");
  sparse.valueOffset = values.findInteger("byteOffset", 0);
  const BufferView& indexView = model.bufferViews[std::size_t(sparse.indexView)];
  const BufferView& valueView = model.bufferViews[std::size_t(sparse.valueView)];
  const std::size_t indexBytes = componentBytes(sparse.indexType),
                    valueBytes = elementBytes(accessor.element, accessor.component);
  checkTight(indices, indexView, indexBytes);
  checkTight(values, valueView, valueBytes);
  checkRange(indices, indexView, sparse.indexOffset, sparse.count, indexBytes, indexBytes);
  checkRange(values, valueView, sparse.valueOffset, sparse.count, valueBytes,
             componentBytes(accessor.component));
  return sparse;
}

void readAccessor(const Element& element, Model& model) {
  Accessor accessor;
  accessor.bufferView = element.findIndex("bufferView", model.bufferViews.size(), "buffer view");
  accessor.byteOffset = element.findInteger("byteOffset", 0);
  accessor.component = readComponentType(element);
  accessor.element = readElementType(element);
  accessor.normalized = element.findBool("normalized", false);
  accessor.count = element.getInteger("count", 1);
  const bool isWide =
      accessor.component == ComponentType::Float || accessor.component == ComponentType::Uint32;
  if (accessor.normalized && isWide)
    element.find("normalized")->fail("gltf.accessor_format", "only 8 and 16 bit integers can be normalized");
  if (accessor.bufferView < 0 && element.has("byteOffset"))
    element.find("byteOffset")->fail("gltf.missing", "a byteOffset needs a bufferView");
  for (const char* bound : {"min", "max"})
    if (const auto list = element.findArray(bound)) list->requireSize(componentCount(accessor.element));
  if (accessor.bufferView >= 0) {
    const bool isSmallMatrix = accessor.element >= ElementType::Mat2;
    checkRange(element, model.bufferViews[std::size_t(accessor.bufferView)], accessor.byteOffset,
               accessor.count, elementBytes(accessor.element, accessor.component),
               isSmallMatrix ? 4 : componentBytes(accessor.component));
  }
  if (const auto sparse = element.findObject("sparse"))
    accessor.sparse = readSparse(*sparse, model, accessor);
  model.accessors.push_back(accessor);
}

}  // namespace

void readBuffers(Context&, const Element& root, Model& model, const Container& container) {
  forEachObject(root, "buffers", [&](const Element& element, std::size_t index) {
    Buffer buffer;
    buffer.byteLength = element.getInteger("byteLength", 1);
    if (element.has("uri")) buffer.uri = element.getString("uri");
    // A buffer without data may be a placeholder of an extension: it is refused when something wants its
    // bytes.
    if (!buffer.uri && index == 0 && container.isGlb && !container.hasBinary)
      element.fail("gltf.buffer_size", "the GLB has no BIN chunk for this buffer",
                   "the file is damaged or was cut short");
    model.buffers.push_back(std::move(buffer));
  });
  forEachObject(root, "bufferViews",
                [&](const Element& element, std::size_t) { readBufferView(element, model); });
}

void readAccessors(Context&, const Element& root, Model& model) {
  forEachObject(root, "accessors",
                [&](const Element& element, std::size_t) { readAccessor(element, model); });
}

}  // namespace catoptric::scene::gltf
