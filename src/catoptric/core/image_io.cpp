// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/image_io.h"

#include <new>
#include <string_view>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/image_codec.h"

namespace catoptric::core {
namespace {

std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
  return asText(bytes).substr(0, magic.size()) == magic;
}

bool isWebp(std::span<const std::byte> bytes) {
  return startsWith(bytes, "RIFF") && bytes.size() >= 12 && asText(bytes).substr(8, 4) == "WEBP";
}

/// Names what it is instead, where that is known, so that the user need not guess.
[[noreturn]] void throwUnknownFormat(std::span<const std::byte> bytes, const std::string& name,
                                     const std::string& expected) {
  struct Known {
    std::string_view magic, format;
  };
  static constexpr Known kKnown[] = {
      {"GIF8", "GIF"},
      {"BM", "BMP"},
      {"DDS ", "DDS"},
      {"II*", "TIFF"},
      {"MM", "TIFF"},
      {{"\xABKTX", 4}, "KTX"},
      {{"\x89PNG", 4}, "PNG"},
      {{"\xFF\xD8", 2}, "JPEG"},
      {"RIFF", "WebP"},
      {"#?", "Radiance .hdr"},
      {{"\x76\x2f\x31\x01", 4}, "OpenEXR"},
      {"<", "text, perhaps SVG or HTML"},
  };
  std::string what = bytes.empty() ? "it is empty" : "its format is unknown";
  for (const Known& known : kKnown)
    if (startsWith(bytes, known.magic)) {
      what = "it is " + std::string(known.format);
      break;
    }
  throw Error("image.unknown_format", "cannot decode image '" + name + "': " + what, {}, "use " + expected);
}

}  // namespace

ImageRgba8 decodeImage(std::span<const std::byte> bytes, const std::string& name, std::size_t maxPixels) {
  try {
    if (startsWith(bytes, {"\x89PNG\r\n\x1a\n", 8})) return codec::decodePng(bytes, name, maxPixels);
    if (startsWith(bytes, "\xFF\xD8\xFF")) return codec::decodeJpeg(bytes, name, maxPixels);
    if (isWebp(bytes)) return codec::decodeWebp(bytes, name, maxPixels);
  } catch (const std::bad_alloc&) {
    throw Error("image.too_large", "image '" + name + "' does not fit into memory");
  }
  throwUnknownFormat(bytes, name, "PNG, JPEG or WebP");
}

ImageRgbF readRadianceImage(const std::filesystem::path& path, std::size_t maxPixels) {
  const std::vector<std::byte> bytes = readFile(path);
  const std::string name = path.string();
  try {
    if (startsWith(bytes, "#?")) return codec::decodeRadianceHdr(bytes, name, maxPixels);
    if (startsWith(bytes, {"\x76\x2f\x31\x01", 4})) return codec::decodeExrRgb(bytes, name, maxPixels);
  } catch (const std::bad_alloc&) {
    throw Error("image.too_large", "image '" + name + "' does not fit into memory");
  }
  throwUnknownFormat(bytes, name, "Radiance .hdr or OpenEXR .exr");
}

}  // namespace catoptric::core
