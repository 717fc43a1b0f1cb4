// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "catoptric/core/error.h"
#include "catoptric/core/image_io.h"
#include "catoptric/scene/gltf/uri.h"

namespace catoptric::scene::gltf {
namespace {

/// glTF 2.0 section 3.11: signed integers map -2^(n-1) and -2^(n-1)+1 both to -1.
template <class Source, class Target>
Target convert(Source value, bool normalized) {
  if constexpr (std::is_integral_v<Source> && std::is_floating_point_v<Target>)
    if (normalized) return std::max(Target(value) / Target(std::numeric_limits<Source>::max()), Target(-1));
  if constexpr (std::is_floating_point_v<Source> && std::is_integral_v<Target>)
    return Target(0);  // integers are read only from accessors of integers
  else
    return Target(value);
}

/// Where the components of an element lie: columns of small matrices start at multiples of 4 bytes.
struct Layout {
  std::size_t components, perColumn, columnBytes;

  explicit Layout(const Accessor& accessor) : components(componentCount(accessor.element)) {
    const std::size_t bytes = componentBytes(accessor.component);
    perColumn = accessor.element >= ElementType::Mat2
                    ? std::size_t(accessor.element) - std::size_t(ElementType::Mat2) + 2
                    : components;
    columnBytes = accessor.element >= ElementType::Mat2 ? (perColumn * bytes + 3) / 4 * 4 : perColumn * bytes;
  }
};

template <class Source, class Target>
void readAs(const std::byte* from, std::size_t stride, std::size_t count, const Layout& layout,
            bool normalized, Target* to) {
  for (std::size_t i = 0; i < count; ++i, from += stride)
    for (std::size_t c = 0; c < layout.components; ++c) {
      Source value;
      std::memcpy(
          &value,
          from + (c / layout.perColumn) * layout.columnBytes + (c % layout.perColumn) * sizeof(Source),
          sizeof(Source));
      *to++ = convert<Source, Target>(value, normalized);
    }
}

/// `count` elements that lie `stride` bytes apart; the caller has checked the range.
template <class Target>
void readRun(const std::byte* from, std::size_t stride, std::size_t count, const Accessor& accessor,
             Target* to) {
  const Layout layout(accessor);
  switch (accessor.component) {
    case ComponentType::Int8:
      return readAs<std::int8_t>(from, stride, count, layout, accessor.normalized, to);
    case ComponentType::Uint8:
      return readAs<std::uint8_t>(from, stride, count, layout, accessor.normalized, to);
    case ComponentType::Int16:
      return readAs<std::int16_t>(from, stride, count, layout, accessor.normalized, to);
    case ComponentType::Uint16:
      return readAs<std::uint16_t>(from, stride, count, layout, accessor.normalized, to);
    case ComponentType::Uint32:
      return readAs<std::uint32_t>(from, stride, count, layout, accessor.normalized, to);
    case ComponentType::Float:
      return readAs<float>(from, stride, count, layout, accessor.normalized, to);
  }
}

}  // namespace

Data::Data(Context& context, const Model& model, const std::filesystem::path& folder,
           std::span<const std::byte> binaryChunk)
    : context_(context), model_(model), folder_(folder) {
  owned_.reserve(model.buffers.size());
  for (std::size_t i = 0; i < model.buffers.size(); ++i) {
    const Buffer& buffer = model.buffers[i];
    const std::string pointer = fmt::format("/buffers/{}", i);
    std::span<const std::byte> bytes;
    if (buffer.uri) {
      owned_.push_back(readUri(context, folder, *buffer.uri, pointer + "/uri"));
      bytes = owned_.back();
    } else if (i == 0) {
      bytes = binaryChunk;
    }
    const bool isPlaceholder = !buffer.uri && bytes.empty();
    if (!isPlaceholder && bytes.size() < buffer.byteLength)
      context.fail("gltf.buffer_size",
                   fmt::format("the buffer should have {} bytes but there are only {}", buffer.byteLength,
                               bytes.size()),
                   pointer, "the file is damaged or was cut short");
    buffers_.push_back(isPlaceholder ? bytes : bytes.first(buffer.byteLength));
  }
}

std::span<const std::byte> Data::viewBytes(int bufferView) const {
  const BufferView& view = model_.bufferViews[std::size_t(bufferView)];
  const std::span<const std::byte> buffer = buffers_[std::size_t(view.buffer)];
  if (buffer.empty())
    context_.fail("gltf.buffer_size", "the buffer has no data, neither by a URI nor in the file",
                  fmt::format("/bufferViews/{}", bufferView),
                  "if it was made with EXT_meshopt_compression, export it without");
  return buffer.subspan(view.byteOffset, view.byteLength);
}

template <class Target>
void Data::putSparse(int index, std::vector<Target>& out) const {
  const Accessor& accessor = model_.accessors[std::size_t(index)];
  const SparseValues& sparse = *accessor.sparse;
  const std::string pointer = fmt::format("/accessors/{}/sparse", index);
  context_.charge(sparse.count, sizeof(std::uint32_t) + componentCount(accessor.element) * sizeof(Target),
                  pointer);
  Accessor indexFormat;
  indexFormat.component = sparse.indexType;
  std::vector<std::uint32_t> indices(sparse.count);
  readRun(viewBytes(sparse.indexView).data() + sparse.indexOffset, componentBytes(sparse.indexType),
          sparse.count, indexFormat, indices.data());
  const std::size_t components = componentCount(accessor.element);
  std::vector<Target> values(sparse.count * components);
  readRun(viewBytes(sparse.valueView).data() + sparse.valueOffset,
          elementBytes(accessor.element, accessor.component), sparse.count, accessor, values.data());
  for (std::size_t i = 0; i < sparse.count; ++i) {
    if (indices[i] >= accessor.count)
      context_.fail(
          "gltf.index_out_of_range",
          fmt::format("sparse index {} of an accessor with {} elements", indices[i], accessor.count),
          pointer + "/indices");
    if (i > 0 && indices[i] <= indices[i - 1])
      context_.fail("gltf.accessor_data", "sparse indices must increase", pointer + "/indices");
    std::copy_n(values.begin() + std::ptrdiff_t(i * components), components,
                out.begin() + std::ptrdiff_t(indices[i] * components));
  }
}

template <class Target>
std::vector<Target> Data::readElements(int index) const {
  const Accessor& accessor = model_.accessors[std::size_t(index)];
  const std::size_t components = componentCount(accessor.element);
  context_.charge(accessor.count, components * sizeof(Target), fmt::format("/accessors/{}", index));
  std::vector<Target> out(accessor.count * components, Target(0));
  if (accessor.bufferView >= 0) {
    const BufferView& view = model_.bufferViews[std::size_t(accessor.bufferView)];
    const std::size_t stride =
        view.byteStride != 0 ? view.byteStride : elementBytes(accessor.element, accessor.component);
    readRun(viewBytes(accessor.bufferView).data() + accessor.byteOffset, stride, accessor.count, accessor,
            out.data());
  }
  if (accessor.sparse) putSparse(index, out);
  return out;
}

std::vector<float> Data::readFloats(int accessor) const {
  return readElements<float>(accessor);
}

std::vector<std::uint32_t> Data::readIntegers(int accessor) const {
  return readElements<std::uint32_t>(accessor);
}

core::ImageRgba8 Data::readImage(int index) const {
  const Image& image = model_.images[std::size_t(index)];
  const std::string pointer = fmt::format("/images/{}", index);
  std::vector<std::byte> owned;
  if (image.uri) owned = readUri(context_, folder_, *image.uri, pointer + "/uri");
  const std::span<const std::byte> bytes =
      image.uri ? std::span<const std::byte>(owned) : viewBytes(image.bufferView);
  const std::size_t affordable = context_.remainingBytes() / sizeof(glm::u8vec4);
  try {
    core::ImageRgba8 out =
        core::decodeImage(bytes, "image", std::min(context_.options().maxPixels, affordable));
    context_.charge(out.size(), sizeof(glm::u8vec4), pointer);
    return out;
  } catch (const core::Error& error) {
    if (error.code().starts_with("gltf.")) throw;
    context_.fail("gltf.image", error.message(), pointer, error.hint());
  }
}

}  // namespace catoptric::scene::gltf
