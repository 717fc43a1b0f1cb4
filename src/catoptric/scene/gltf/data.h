// SPDX-License-Identifier: Apache-2.0
// The bytes behind a validated document: buffers, the elements of accessors, the decoded images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/scene/gltf/context.h"
#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {

/// Reads every buffer at once (a missing file is an error even if nothing uses it) and hands out checked
/// spans.
class Data {
 public:
  Data(Context& context, const Model& model, const std::filesystem::path& folder,
       std::span<const std::byte> binaryChunk);

  /// Elements of `accessor` as floats, `componentCount` each, column by column for matrices: normalised,
  /// sparse values put in. Charged to the budget.
  [[nodiscard]] std::vector<float> readFloats(int accessor) const;

  /// The same for unsigned integers (indices, joints), not normalised.
  [[nodiscard]] std::vector<std::uint32_t> readIntegers(int accessor) const;

  /// Decodes an image (PNG, JPEG, WebP). Charged to the budget.
  [[nodiscard]] core::ImageRgba8 readImage(int image) const;

  [[nodiscard]] Context& context() const { return context_; }
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  [[nodiscard]] std::span<const std::byte> viewBytes(int bufferView) const;
  template <class Target>
  std::vector<Target> readElements(int accessor) const;
  template <class Target>
  void putSparse(int accessor, std::vector<Target>& out) const;

  Context& context_;
  const Model& model_;
  std::filesystem::path folder_;
  std::vector<std::vector<std::byte>> owned_;
  std::vector<std::span<const std::byte>> buffers_;  ///< Exactly byteLength bytes each; empty: placeholder.
};

}  // namespace catoptric::scene::gltf
