// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/zexel_map.h"

#include <algorithm>
#include <cassert>

namespace catoptric::depth_reflection_map {
namespace {

constexpr int kShortestSide = 16;

void fillTiles(ZexelLevel& level) {
  level.tileColumns = (level.width + kZexelTile - 1) / kZexelTile;
  level.tileRows = (level.height + kZexelTile - 1) / kZexelTile;
  level.tiles.assign(std::size_t(level.tileColumns) * std::size_t(level.tileRows), {1e30f, -1e30f});
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x) {
      const float d = level.disparities[std::size_t(y) * std::size_t(level.width) + std::size_t(x)];
      ZexelLevel::Tile& tile = level.tiles[std::size_t(y / kZexelTile) * std::size_t(level.tileColumns) +
                                           std::size_t(x / kZexelTile)];
      tile.least = std::min(tile.least, d);
      tile.largest = std::max(tile.largest, d);
    }
}

}  // namespace

std::size_t ZexelMap::bytes() const {
  std::size_t sum = 0;
  for (const ZexelLevel& level : levels)
    sum += level.disparities.size() * sizeof(float) + level.tiles.size() * sizeof(ZexelLevel::Tile);
  return sum;
}

ZexelMap makeZexelMap(int width, int height, std::span<const float> disparities) {
  assert(disparities.size() == std::size_t(width) * std::size_t(height));
  ZexelMap map{width, height, {}};
  for (int step = 1; step == 1 || std::min(width, height) / step >= kShortestSide; step *= 2) {
    ZexelLevel level;
    level.step = step;
    level.width = (width - step / 2 + step - 1) / step;
    level.height = (height - step / 2 + step - 1) / step;
    level.disparities.reserve(std::size_t(level.width) * std::size_t(level.height) + ZexelLevel::kPadding);
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        level.disparities.push_back(
            disparities[std::size_t(level.base(y)) * std::size_t(width) + std::size_t(level.base(x))]);
    level.disparities.insert(level.disparities.end(), ZexelLevel::kPadding, 0.0f);
    fillTiles(level);
    map.levels.push_back(std::move(level));
  }
  return map;
}

}  // namespace catoptric::depth_reflection_map
