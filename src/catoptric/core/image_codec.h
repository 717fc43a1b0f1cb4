// SPDX-License-Identifier: Apache-2.0
// Private to core: the codecs behind image_io.h, one .cpp each. The C libraries report errors by longjmp; so
// every function that calls setjmp holds nothing that has a destructor, and its state lives in the caller's
// frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "catoptric/core/error.h"
#include "catoptric/core/image.h"

namespace catoptric::core::codec {

using Bytes = std::span<const std::byte>;

[[nodiscard]] ImageRgba8 decodePng(Bytes bytes, const std::string& name, std::size_t maxPixels);
[[nodiscard]] ImageRgba8 decodeJpeg(Bytes bytes, const std::string& name, std::size_t maxPixels);
[[nodiscard]] ImageRgba8 decodeWebp(Bytes bytes, const std::string& name, std::size_t maxPixels);
[[nodiscard]] ImageRgbF decodeRadianceHdr(Bytes bytes, const std::string& name, std::size_t maxPixels);
[[nodiscard]] ImageRgbF decodeExrRgb(Bytes bytes, const std::string& name, std::size_t maxPixels);

[[noreturn]] inline void throwDamaged(const std::string& name, const std::string& why) {
  throw Error("image.damaged", "cannot decode image '" + name + "': " + why);
}

[[noreturn]] inline void throwUnsupported(const std::string& name, const std::string& what,
                                          const std::string& hint) {
  throw Error("image.unsupported", "cannot decode image '" + name + "': " + what, {}, hint);
}

/// To be called before the pixels are allocated.
inline void checkPixelCount(std::uint64_t width, std::uint64_t height, const std::string& name,
                            std::size_t maxPixels) {
  if (width == 0 || height == 0) throwDamaged(name, "it has no pixels");
  if (width > 0x7fffffffu || height > 0x7fffffffu || height > maxPixels / width)
    throw Error("image.too_large",
                "image '" + name + "' has " + std::to_string(width) + "x" + std::to_string(height) +
                    " pixels, more than the limit of " + std::to_string(maxPixels),
                {}, "raise the limit on pixels if the file can be trusted");
}

}  // namespace catoptric::core::codec
