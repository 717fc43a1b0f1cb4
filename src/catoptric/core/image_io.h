// SPDX-License-Identifier: Apache-2.0
// Reading and writing of image files. Every writer goes through core/file.h: whole file or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::core {

/// Images larger than this are refused before they are decoded (command line: --max-pixels).
inline constexpr std::size_t kDefaultMaxPixels = std::size_t(1) << 26;

/// Decodes PNG, JPEG or WebP from memory to 8-bit RGBA as stored (no colour conversion, 16-bit PNG rounded to
/// 8). `name` is used in error messages. Throws Error ("image.*") for anything damaged, unknown or over
/// maxPixels.
[[nodiscard]] ImageRgba8 decodeImage(std::span<const std::byte> bytes, const std::string& name,
                                     std::size_t maxPixels = kDefaultMaxPixels);

/// Reads linear radiance from .hdr (Radiance RGBE) or .exr (R, G, B). Throws Error.
[[nodiscard]] ImageRgbF readRadianceImage(const std::filesystem::path& path,
                                          std::size_t maxPixels = kDefaultMaxPixels);

/// One named channel of an EXR file; exactly one of the two spans is used, both are row-major, top row first.
struct ExrChannel {
  std::string name;                    ///< "R", "seen.X", "object.id", ...
  std::span<const float> values;       ///< Written as 32-bit float ...
  std::span<const std::uint32_t> ids;  ///< ... or as 32-bit unsigned integer.
  int stride = 1;                      ///< In elements of the span.
};

/// Encoders to memory. Bytes depend on the pixels only (no time stamps), so two runs give identical files.
/// `description` goes into a PNG's text chunk of that name, unless it is empty.
[[nodiscard]] std::vector<std::byte> encodePng(const ImageRgba8& image, const std::string& description = {});
[[nodiscard]] std::vector<std::byte> encodeJpeg(const ImageRgba8& image, int quality = 92);
[[nodiscard]] std::vector<std::byte> encodeExr(int widthPx, int heightPx,
                                               std::span<const ExrChannel> channels);

/// Reads all channels of an EXR file as float (integers converted); for tests and `compare`.
struct ExrImage {
  int widthPx = 0, heightPx = 0;
  std::vector<std::string> names;
  std::vector<std::vector<float>> values;  ///< One per name.
};
[[nodiscard]] ExrImage readExr(const std::filesystem::path& path, std::size_t maxPixels = kDefaultMaxPixels);

}  // namespace catoptric::core
