// SPDX-License-Identifier: Apache-2.0
// The processor's side of a reference image: disparities, and coarser versions of them (the hierarchical map
// of Bastos & Stuerzlinger's future work). Colours and objects stay where they were drawn, on the GPU.
//
// Level k keeps one zexel of each 2^k x 2^k block, unchanged: depths of different surfaces have no mean.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::depth_reflection_map {

constexpr int kZexelTile = 32;  ///< edge of a tile, zexels of its level

struct ZexelLevel {
  int step = 1;  ///< zexels of level 0 per zexel of this one
  int width = 0, height = 0;
  /// Bottom row first; kPadding zeros follow, so that lanes may be read beyond the last one.
  std::vector<float> disparities;
  static constexpr int kPadding = 8;

  struct Tile {
    float least = 0, largest = 0;  ///< disparity
  };
  int tileColumns = 0, tileRows = 0;
  std::vector<Tile> tiles;

  /// Where a zexel of this level lies in level 0, as a column or row number there.
  [[nodiscard]] int base(int i) const { return i * step + step / 2; }
};

struct ZexelMap {
  int width = 0, height = 0;
  std::vector<ZexelLevel> levels;

  [[nodiscard]] std::size_t bytes() const;
};

/// `disparities`: bottom row first, 0 at the sky. As many levels as leave the shorter side 16 zexels.
[[nodiscard]] ZexelMap makeZexelMap(int width, int height, std::span<const float> disparities);

}  // namespace catoptric::depth_reflection_map
