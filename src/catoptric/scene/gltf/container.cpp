// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/container.h"

#include <fmt/format.h>

#include <cstdint>
#include <set>
#include <string_view>

#include "catoptric/core/error.h"

namespace catoptric::scene::gltf {
namespace {

constexpr std::uint32_t kMagicGlb = 0x46546C67, kChunkJson = 0x4E4F534A, kChunkBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr int kMaxJsonDepth = 256;
/// What one JSON value costs in memory, all told (value, allocator, tree node of an object's member).
constexpr std::size_t kBytesPerJsonValue = 64;

std::uint32_t readUint32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t(bytes[offset + i]) << (8 * i);
  return value;
}

/// Checks the 12-byte header and returns the bytes that belong to the GLB.
std::span<const std::byte> checkHeader(Context& context, std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes)
    context.fail("gltf.glb", fmt::format("a GLB header has 12 bytes, the file has only {}", bytes.size()));
  if (readUint32(bytes, 0) != kMagicGlb)
    context.fail("gltf.glb", "not a GLB file: it does not start with the letters glTF");
  if (const std::uint32_t version = readUint32(bytes, 4); version != 2)
    context.fail("gltf.version", fmt::format("GLB version {} is not supported, only version 2", version));
  const std::size_t length = readUint32(bytes, 8);
  if (length > bytes.size())
    context.fail("gltf.glb", fmt::format("the GLB header says {} bytes, the file has {}; it was cut short",
                                         length, bytes.size()));
  if (length < kHeaderBytes + kChunkHeaderBytes)
    context.fail("gltf.glb", fmt::format("the GLB header says {} bytes, too few for any content", length));
  if (length < bytes.size())
    context.warn(fmt::format("{} bytes after the end of the GLB were ignored", bytes.size() - length));
  return bytes.first(length);
}

/// Depth, duplicate keys and memory, watched while the parser runs.
class JsonGuard {
 public:
  explicit JsonGuard(Context& context) : context_(context) {}

  bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
    context_.charge(1, kBytesPerJsonValue);
    if (depth > kMaxJsonDepth)
      context_.fail("gltf.json", fmt::format("JSON is nested more than {} levels deep", kMaxJsonDepth));
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end) keys_.pop_back();
    if (event == Json::parse_event_t::key &&
        !keys_.back().insert(parsed.get_ref<const std::string&>()).second)
      context_.fail("gltf.json", fmt::format("a JSON object has the key \"{}\" twice",
                                             printable(parsed.get_ref<const std::string&>())));
    return true;
  }

 private:
  Context& context_;
  std::vector<std::set<std::string>> keys_;  ///< Of the objects that are open, outermost first.
};

}  // namespace

Container openContainer(Context& context, std::span<const std::byte> bytes) {
  const bool saysGlb = context.name().ends_with(".glb") || context.name().ends_with(".GLB");
  if (!saysGlb && (bytes.size() < 4 || readUint32(bytes, 0) != kMagicGlb))
    return {.json = bytes, .binary = {}};
  bytes = checkHeader(context, bytes);
  Container out{.json = {}, .binary = {}, .isGlb = true};
  bool hasJson = false, isSecond = false;
  for (std::size_t offset = kHeaderBytes; offset < bytes.size();) {
    if (bytes.size() - offset < kChunkHeaderBytes)
      context.fail("gltf.glb", fmt::format("the GLB ends within the chunk header at byte {}", offset));
    const std::size_t length = readUint32(bytes, offset);
    const std::uint32_t type = readUint32(bytes, offset + 4);
    offset += kChunkHeaderBytes;
    if (length % 4 != 0)
      context.fail("gltf.glb",
                   fmt::format("the GLB chunk at byte {} has {} bytes, not a multiple of 4", offset, length));
    if (length > bytes.size() - offset)
      context.fail("gltf.glb", fmt::format("the GLB chunk at byte {} has {} bytes, the file only {} more",
                                           offset, length, bytes.size() - offset));
    const std::span<const std::byte> data = bytes.subspan(offset, length);
    offset += length;
    if (!hasJson && type != kChunkJson) context.fail("gltf.glb", "the first chunk of the GLB is not JSON");
    if ((type == kChunkJson && hasJson) || (type == kChunkBinary && out.hasBinary))
      context.fail("gltf.glb", "the GLB has two chunks of the same kind");
    if (type == kChunkJson) {
      out.json = data;
      hasJson = true;
    } else if (type == kChunkBinary) {
      if (!isSecond) context.fail("gltf.glb", "the BIN chunk must be the second chunk of the GLB");
      out.binary = data;
      out.hasBinary = true;
    }  // chunks of other types are for extensions and are to be skipped
    isSecond = type == kChunkJson;
  }
  return out;
}

Json parseJson(Context& context, std::span<const std::byte> text) {
  const char* begin = reinterpret_cast<const char*>(text.data());
  // Trailing zero bytes pad the JSON chunk of some writers; the specification asks for blanks.
  std::string_view view(begin, text.size());
  while (view.ends_with('\0')) view.remove_suffix(1);
  if (view.empty()) context.fail("gltf.json", "there is no JSON in the file");
  if (view.starts_with("\xEF\xBB\xBF"))
    context.warn("the JSON text starts with a byte order mark, which was skipped");
  context.charge(view.size(), 1);
  try {
    JsonGuard guard(context);
    return Json::parse(view.begin(), view.end(), std::ref(guard));
  } catch (const Json::parse_error& error) {
    context.fail(
        "gltf.json",
        fmt::format("not valid JSON near byte {}; the file is damaged or is not a glTF file", error.byte));
  } catch (const Json::exception&) {
    context.fail("gltf.json", "the JSON has a number that is too large to be represented");
  }
}

}  // namespace catoptric::scene::gltf
