// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"

namespace catoptric::scene::gltf {
namespace {

namespace fs = std::filesystem;

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// A '%' that is not followed by two hexadecimal digits stays as it is ("100%.png").
std::string decodePercent(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool encoded =
        text[i] == '%' && i + 2 < text.size() && hexValue(text[i + 1]) >= 0 && hexValue(text[i + 2]) >= 0;
    if (encoded) {
      out += char(hexValue(text[i + 1]) * 16 + hexValue(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

int base64Value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

/// Strict but for missing padding; nullopt for any other character.
std::optional<std::vector<std::byte>> decodeBase64(std::string_view text) {
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bitCount = 0;
  for (const char c : text) {
    const int value = base64Value(c);
    if (value < 0) return std::nullopt;
    bits = ((bits << 6) | std::uint32_t(value)) & 0xFFFFFFu;
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      out.push_back(std::byte((bits >> bitCount) & 0xFFu));
    }
  }
  return out;
}

/// A colon before the first slash: a scheme, or what some reader could take for one.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

bool isInside(const fs::path& file, const fs::path& folder) {
  const auto [folderEnd, fileAt] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return folderEnd == folder.end() && fileAt != file.end();
}

bool startsWithIgnoringCase(std::string_view text, std::string_view lowerCasePrefix) {
  return text.size() >= lowerCasePrefix.size() &&
         std::equal(lowerCasePrefix.begin(), lowerCasePrefix.end(), text.begin(),
                    [](char a, char b) { return a == char(std::tolower(static_cast<unsigned char>(b))); });
}

[[noreturn]] void failUri(const Context& context, const std::string& uri, const std::string& why,
                          const std::string& pointer) {
  context.fail("gltf.uri", fmt::format("the URI \"{}\" {}", printable(uri), why), pointer,
               "only files in the scene's own folder and data: URIs are read");
}

}  // namespace

bool isDataUri(std::string_view uri) {
  return startsWithIgnoringCase(uri, "data:");
}

std::vector<std::byte> decodeDataUri(Context& context, std::string_view uri, const std::string& pointer) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos)
    context.fail("gltf.uri", "a data: URI must have a comma before its data", pointer);
  const std::string_view type = uri.substr(5, comma - 5), data = uri.substr(comma + 1);
  if (type.find(";;") != std::string_view::npos)
    context.fail("gltf.uri", "the media type of the data: URI is malformed", pointer);
  context.charge(data.size(), 1, pointer);
  const std::string plain = decodePercent(data);
  if (!type.ends_with(";base64")) {
    const auto* bytes = reinterpret_cast<const std::byte*>(plain.data());
    return {bytes, bytes + plain.size()};
  }
  std::optional<std::vector<std::byte>> bytes = decodeBase64(plain);
  if (!bytes) context.fail("gltf.uri", "the data: URI is not valid base64", pointer);
  return std::move(*bytes);
}

fs::path checkFileUri(Context& context, const std::string& uri, const std::string& pointer) {
  const auto refuse = [&](const std::string& why) { failUri(context, uri, why, pointer); };
  if (uri.empty()) refuse("is empty");
  if (hasScheme(uri)) refuse("has a scheme");
  const std::string name = decodePercent(uri);
  if (name.find('\0') != std::string::npos) refuse("contains a zero byte");
  if (name.find('\\') != std::string::npos) refuse("contains a backslash; folders are separated by /");
  fs::path relative(name);
  if (relative.is_absolute()) refuse("is an absolute path");
  for (const fs::path& part : relative)
    if (part == "..") refuse("leaves the scene's folder");
  return relative;
}

fs::path resolveFileUri(Context& context, const fs::path& folder, const std::string& uri,
                        const std::string& pointer) {
  const fs::path relative = checkFileUri(context, uri, pointer);
  if (folder.empty())
    failUri(context, uri, "cannot be resolved, the scene was not read from a folder", pointer);
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  fs::path file = error ? fs::path() : fs::canonical(folder / relative, error);
  if (error)
    context.fail(
        "gltf.file",
        fmt::format("the file \"{}\" that the scene needs cannot be found", printable(relative.string())),
        pointer, "put it beside the scene file");
  if (!isInside(file, root))
    failUri(context, uri, "leads out of the scene's folder through a symbolic link", pointer);
  if (!fs::is_regular_file(file, error)) failUri(context, uri, "does not name a regular file", pointer);
  return file;
}

std::vector<std::byte> readUri(Context& context, const fs::path& folder, const std::string& uri,
                               const std::string& pointer) {
  if (isDataUri(uri)) return decodeDataUri(context, uri, pointer);
  const fs::path file = resolveFileUri(context, folder, uri, pointer);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error) context.charge(size, 1, pointer);
  try {
    // One byte may have been added since: the cap holds all the same.
    return core::readFile(file, error ? context.remainingBytes() : std::size_t(size));
  } catch (const core::Error& failure) {
    context.fail("gltf.file", failure.message(), pointer);
  }
}

}  // namespace catoptric::scene::gltf
