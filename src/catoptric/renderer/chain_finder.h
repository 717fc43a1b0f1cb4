// SPDX-License-Identifier: Apache-2.0
// Which mirrors does a level of mirrors show, through which chains, and where?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/raster/chain.h"
#include "catoptric/raster/level.h"

namespace catoptric::renderer {

class ChainFinder {
 public:
  explicit ChainFinder(const scene::WorldGeometry& world) : world_(world) {}

  /// Chains count from 1 again.
  void beginFrame() { lastChain_ = 0; }
  /// Chains of at most `bounces` mirrors and scene::kMostCrossings refractors that those visible in a level
  /// begin; `parents`: the chains of that level. Reads the level's ids back. `isComplete`: there are no more.
  [[nodiscard]] std::vector<raster::Chain> find(const raster::Level& level,
                                                const std::vector<raster::Chain>& parents, int bounces,
                                                bool& isComplete);
  /// Of the last level, bottom row first.
  [[nodiscard]] std::span<const uvec2> ids() const { return ids_; }

 private:
  const scene::WorldGeometry& world_;
  std::vector<uvec2> ids_;
  std::uint32_t lastChain_ = 0;
};

}  // namespace catoptric::renderer
