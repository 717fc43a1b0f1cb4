// SPDX-License-Identifier: Apache-2.0
// The outermost layer of a scene file: GLB chunks, then JSON text.
// Both are read before anything in them is believed: chunk lengths are checked against the file, JSON is
// parsed without recursion, its depth and its memory are bounded, and an object that has one key twice is
// refused (which of the two counts differs from reader to reader).
#pragma once

#include <cstddef>
#include <span>

#include "catoptric/scene/gltf/context.h"
#include "catoptric/scene/gltf/element.h"

namespace catoptric::scene::gltf {

struct Container {
  std::span<const std::byte> json;
  std::span<const std::byte> binary;  ///< The BIN chunk of a GLB; empty if there is none.
  bool isGlb = false;
  bool hasBinary = false;
};

/// Splits a GLB; a text file is returned as it is. Spans refer into `bytes`.
[[nodiscard]] Container openContainer(Context& context, std::span<const std::byte> bytes);

/// Parses the JSON text. Throws "gltf.json".
[[nodiscard]] Json parseJson(Context& context, std::span<const std::byte> text);

}  // namespace catoptric::scene::gltf
