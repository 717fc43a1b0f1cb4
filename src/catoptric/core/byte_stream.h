// SPDX-License-Identifier: Apache-2.0
// Little-endian numbers to bytes and back, with every read checked.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace catoptric::core {

static_assert(std::endian::native == std::endian::little, "the file is mapped as it is");

class ByteWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
  }
  template <class Value>
  void putAll(std::span<const Value> values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto raw = std::as_bytes(values);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads what a ByteWriter wrote. `refuse(what)` is called where a read does not fit, and throws.
class ByteReader {
 public:
  using Refuse = void (*)(const char* what);
  ByteReader(std::span<const std::byte> bytes, Refuse refuse) : bytes_(bytes), refuse_(refuse) {}

  template <class Value>
  [[nodiscard]] Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// `count` may be anything: it is compared with what is there before memory is asked for.
  template <class Value>
  [[nodiscard]] std::vector<Value> getAll(std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (count > bytes_.size() / sizeof(Value)) refuse_("it ends too early");
    std::vector<Value> values(static_cast<std::size_t>(count));
    const auto raw = take(values.size() * sizeof(Value));
    if (!values.empty()) std::memcpy(values.data(), raw.data(), raw.size());
    return values;
  }
  [[nodiscard]] std::span<const std::byte> take(std::size_t count) {
    if (count > bytes_.size()) refuse_("it ends too early");
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  [[nodiscard]] bool isAtEnd() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  Refuse refuse_;
};

/// FNV-1a over 8-byte words, for damage and not for malice.
[[nodiscard]] inline std::uint64_t computeChecksum(std::span<const std::byte> bytes,
                                                   std::uint64_t hash = 0xcbf29ce484222325u) {
  constexpr std::uint64_t kPrime = 0x100000001b3u;
  while (bytes.size() >= 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data(), 8);
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 32;
    bytes = bytes.subspan(8);
  }
  for (const std::byte b : bytes) hash = (hash ^ std::uint64_t(b)) * kPrime;
  return hash ^ (hash >> 29);
}

}  // namespace catoptric::core
