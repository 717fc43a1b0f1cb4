// SPDX-License-Identifier: Apache-2.0
// Which mirrors does a level of mirrors show, through which chains, and where?
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "catoptric/raster/chain.h"
#include "catoptric/raster/level.h"

namespace catoptric::renderer {

struct VisibleMirrors {
  std::vector<raster::Chain> chains;
  /// Of more bounces or crossings than are asked for, or more than ids can tell apart: they show the
  /// environment.
  std::vector<raster::Chain> unfollowed;
  std::vector<gl::Scissor> rects;  ///< that hold the pixels of all of them, and few others
};

class ChainFinder {
 public:
  explicit ChainFinder(const scene::WorldGeometry& world) : world_(world) {}

  /// Chains count from 1 again.
  void beginFrame() { lastChain_ = 0; }
  /// Chains of at most `bounces` mirrors and scene::kMostCrossings refractors that those visible in a level
  /// begin; `parents`: the chains of that level. Reads the level's ids back, in `rects` alone, which hold all
  /// its mirrors and may overlap; empty: wherever something is drawn.
  [[nodiscard]] VisibleMirrors find(const raster::Level& level, const std::vector<raster::Chain>& parents,
                                    int bounces, std::span<const gl::Scissor> rects = {});
  /// Of the last level, bottom row first; right within the bounds of its chains, elsewhere perhaps from
  /// before.
  [[nodiscard]] std::span<const uvec2> ids() const { return ids_; }

  /// Where on the screen a mirror is.
  struct Extent {
    int x0, y0, x1, y1;
    std::uint64_t pixels;
  };
  /// What is found in some rows of pixels; by ids.g.
  struct Rows {
    std::map<std::uint32_t, Extent> extents;
    std::vector<gl::Scissor> rects;
  };

 private:
  void readIds(const raster::Level& level, std::span<const gl::Scissor> rects);

  const scene::WorldGeometry& world_;
  std::vector<uvec2> ids_;
  std::vector<gl::Scissor> rects_;  ///< that were read
  std::vector<Rows> rows_;
  std::uint32_t lastChain_ = 0;
};

}  // namespace catoptric::renderer
