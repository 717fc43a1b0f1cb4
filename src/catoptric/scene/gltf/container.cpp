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

/// Looks through the text before a document is built from it: depth, duplicate keys, memory. (A parser
/// callback could do this in one pass, but nlohmann's then searches the whole parent array at the end of
/// every object.)
class JsonGuard final : public nlohmann::json_sax<Json> {
 public:
  explicit JsonGuard(Context& context) : context_(context) {}

  bool null() override { return countValue(); }
  bool boolean(bool) override { return countValue(); }
  bool number_integer(number_integer_t) override { return countValue(); }
  bool number_unsigned(number_unsigned_t) override { return countValue(); }
  bool number_float(number_float_t, const string_t&) override { return countValue(); }
  bool string(string_t&) override { return countValue(); }
  bool binary(binary_t&) override { return countValue(); }
  bool start_object(std::size_t) override {
    keys_.emplace_back();
    return enter();
  }
  bool end_object() override {
    keys_.pop_back();
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool key(string_t& name) override {
    if (!keys_.back().insert(name).second)
      context_.fail("gltf.json", fmt::format("a JSON object has the key \"{}\" twice", printable(name)));
    return countValue();
  }
  bool parse_error(std::size_t byte, const std::string&, const Json::exception& error) override {
    // Codes 101 to 199 are errors of the syntax; 406 is a number beyond the range of double.
    if (error.id >= 400)
      context_.fail("gltf.json", fmt::format("a number near byte {} is too large to be represented", byte));
    context_.fail(
        "gltf.json",
        fmt::format("not valid JSON near byte {}; the file is damaged or is not a glTF file", byte));
  }

 private:
  bool countValue() {
    context_.charge(1, kBytesPerJsonValue);
    return true;
  }
  bool enter() {
    if (++depth_ > kMaxJsonDepth)
      context_.fail("gltf.json", fmt::format("JSON is nested more than {} levels deep", kMaxJsonDepth));
    return countValue();
  }

  Context& context_;
  int depth_ = 0;
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
  JsonGuard guard(context);
  (void)Json::sax_parse(view.begin(), view.end(), &guard);
  return Json::parse(view.begin(), view.end());
}

}  // namespace catoptric::scene::gltf
