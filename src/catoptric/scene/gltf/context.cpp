// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/context.h"

#include <fmt/format.h>

#include "catoptric/core/error.h"

namespace catoptric::scene::gltf {
namespace {

/// "{}" is the number of cases.
constexpr std::array<const char*, std::size_t(Repair::Count)> kRepairTexts = {
    "{} triangles, lines or points with NaN or infinite positions were left out",
    "{} triangles, lines or points beyond 1e15 units were left out",
    "{} triangles of zero area were left out",
    "{} normals were zero or not finite and were recomputed from the triangles",
    "{} normals were more than 10 % off unit length and were normalised",
    "{} tangents were zero, not finite or without a handedness of 1 or -1 and were repaired",
    "{} texture coordinates were not finite and were set to 0",
    "{} vertex colours were outside 0..1 or not finite and were clamped",
    "{} vertices had skin weights that were negative or did not add up to 1; they were normalised",
    "{} node rotations were not unit quaternions and were normalised",
    "{} vertices at the end of a primitive did not make up a whole triangle or line and were left out",
    "{} vertex attributes were not aligned to 4 bytes and were read as they stand",
};

/// A file of a million bad nodes must not give a million lines.
constexpr std::size_t kMaxWarnings = 100;

}  // namespace

Context::Context(std::string_view name, const ImportOptions& options)
    : name_(printable(name)), options_(options) {}

void Context::fail(std::string_view code, const std::string& message, const std::string& pointer,
                   const std::string& hint) const {
  throw core::Error(std::string(code), fmt::format("{}: {}", name_, message), pointer, hint);
}

void Context::warn(const std::string& line) {
  if (warnings_.size() > kMaxWarnings || !said_.insert(line).second) return;
  warnings_.push_back(warnings_.size() < kMaxWarnings ? line : "further warnings were left out");
}

void Context::count(Repair repair, std::size_t howMany) {
  counts_[std::size_t(repair)] += howMany;
}

std::vector<std::string> Context::takeWarnings() {
  for (std::size_t i = 0; i < counts_.size(); ++i)
    if (counts_[i] > 0) warnings_.push_back(fmt::format(fmt::runtime(kRepairTexts[i]), counts_[i]));
  return std::move(warnings_);
}

void Context::charge(std::size_t count, std::size_t bytesEach, const std::string& pointer) {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(count, bytesEach, &bytes) || bytes > remainingBytes())
    fail("gltf.memory",
         fmt::format("needs more memory than the limit of {} MiB allows", options_.maxMemoryBytes >> 20),
         pointer, "raise the limit with --max-memory if the file is to be trusted");
  usedBytes_ += bytes;
}

std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 80))
    out += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? '?' : c;
  // Do not cut a UTF-8 sequence in two.
  if (text.size() > 80) {
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0x80) out.pop_back();
    if (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0xC0) out.pop_back();
    out += "...";
  }
  return out;
}

}  // namespace catoptric::scene::gltf
