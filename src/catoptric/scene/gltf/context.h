// SPDX-License-Identifier: Apache-2.0
// What every step of one import shares: the name used in messages, the limits, the memory budget, the
// warnings. Repairs are counted while the geometry is read and said once, in total, at the end.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/scene/gltf_import.h"

namespace catoptric::scene::gltf {

/// Repairs that are counted; the texts are in context.cpp and in docs/gltf.md.
enum class Repair {
  NonFiniteTriangle,
  HugeTriangle,
  DegenerateTriangle,
  Normal,
  NormalLength,
  Tangent,
  TexCoord,
  Color,
  SkinWeights,
  Rotation,
  LeftoverVertex,
  UnalignedAttribute,
  Count
};

class Context {
 public:
  Context(std::string_view name, const ImportOptions& options);

  /// Throws core::Error with "name: message".
  [[noreturn]] void fail(std::string_view code, const std::string& message, const std::string& pointer = {},
                         const std::string& hint = {}) const;

  /// Says a line once, however often it applies; at most about a hundred lines in all.
  void warn(const std::string& line);
  void count(Repair repair, std::size_t howMany = 1);
  /// Adds the lines of the counted repairs and returns all warnings in the order in which they arose.
  [[nodiscard]] std::vector<std::string> takeWarnings();

  /// Takes count * bytesEach from the budget before they are allocated; throws "gltf.memory" when it is
  /// spent.
  void charge(std::size_t count, std::size_t bytesEach, const std::string& pointer = {});
  [[nodiscard]] std::size_t remainingBytes() const { return options_.maxMemoryBytes - usedBytes_; }

  [[nodiscard]] const ImportOptions& options() const { return options_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  ImportOptions options_;
  std::size_t usedBytes_ = 0;
  std::vector<std::string> warnings_;
  std::set<std::string> said_;
  std::array<std::size_t, std::size_t(Repair::Count)> counts_{};
};

/// A name from the file, safe to print: control characters replaced, cut to 80 bytes.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace catoptric::scene::gltf
