// SPDX-License-Identifier: Apache-2.0
// Triangles of a list asked eight at a time: is each worth drawing?
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::raster {

/// Of triangles [begin, end) of `indices`, those that are kept still. `findDropped(corners)`: bits for those
/// of eight that are not worth drawing, from three times eight indices in a row; where the run has fewer they
/// are filled up with zeros. How many were dropped.
template <class FindDropped>
std::size_t dropByEights(std::span<const std::uint32_t> indices, std::size_t begin, std::size_t end,
                         std::span<std::uint8_t> isKept, const FindDropped& findDropped) {
  constexpr auto kEight = std::size_t(core::kLanes);
  std::size_t dropped = 0;
  for (std::size_t t = begin; t < end; t += kEight) {
    const std::size_t count = std::min(end - t, kEight);
    if (std::all_of(&isKept[t], &isKept[t] + count, [](std::uint8_t kept) { return kept == 0; })) continue;
    std::uint32_t few[3 * kEight] = {};
    const std::uint32_t* corners = &indices[3 * t];
    if (count < kEight) {
      std::copy_n(corners, 3 * count, few);
      corners = few;
    }
    const unsigned bits = findDropped(corners);
    for (std::size_t i = 0; i < count; ++i) {
      const auto isDropped = std::uint8_t(bits >> i & 1u);
      dropped += isKept[t + i] & isDropped;
      isKept[t + i] &= std::uint8_t(isDropped ^ 1u);
    }
  }
  return dropped;
}

}  // namespace catoptric::raster
