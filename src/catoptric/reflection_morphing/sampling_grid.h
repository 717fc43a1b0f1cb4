// SPDX-License-Identifier: Apache-2.0
// The regular grid of sampling locations, and where in it an eye is (2004, section 3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "catoptric/core/math.h"

namespace catoptric::reflection_morphing {

/// The sampling cell of an eye: its eight locations and their weights, which add up to 1.
struct SamplingCell {
  std::array<std::uint32_t, 8> locations{};
  std::array<float, 8> weights{};
};

struct SamplingGrid {
  core::Box box;         ///< first and last locations
  glm::uvec3 counts{2};  ///< at least 2 each way

  [[nodiscard]] std::uint64_t locationCount() const { return std::uint64_t(counts.x) * counts.y * counts.z; }
  [[nodiscard]] dvec3 spacing() const { return (box.upper - box.lower) / dvec3(counts - 1u); }
  [[nodiscard]] dvec3 location(std::uint32_t index) const {
    const dvec3 step(index % counts.x, index / counts.x % counts.y, index / counts.x / counts.y);
    return box.lower + step * spacing();
  }
  /// Nothing outside of the grid's box.
  [[nodiscard]] std::optional<SamplingCell> findCell(const dvec3& eye) const {
    const dvec3 at = (eye - box.lower) / spacing();
    if (!glm::all(glm::greaterThanEqual(at, dvec3(0))) ||
        !glm::all(glm::lessThanEqual(at, dvec3(counts - 1u))))
      return std::nullopt;
    const glm::uvec3 first = glm::min(glm::uvec3(at), counts - 2u);
    const dvec3 part = at - dvec3(first);
    SamplingCell cell;
    for (std::uint32_t k = 0; k < 8; ++k) {
      const glm::uvec3 side(k & 1, (k >> 1) & 1, k >> 2);
      const glm::uvec3 l = first + side;
      cell.locations[k] = l.x + counts.x * (l.y + counts.y * l.z);
      const dvec3 w = glm::mix(1.0 - part, part, dvec3(side));
      cell.weights[k] = float(w.x * w.y * w.z);
    }
    return cell;
  }
};

}  // namespace catoptric::reflection_morphing
