// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/chain_finder.h"

#include <algorithm>
#include <limits>
#include <map>

namespace catoptric::renderer {
namespace {

constexpr std::uint32_t kMaxChains = 4096;  // ids have 16 bits for a chain

/// Where on the screen a mirror is.
struct Extent {
  int x0 = std::numeric_limits<int>::max(), y0 = std::numeric_limits<int>::max(), x1 = -1, y1 = -1;
  std::uint64_t pixels = 0;
};

/// Of all mirrors within `bounds`, by ids.g.
std::map<std::uint32_t, Extent> findExtents(std::span<const uvec2> ids, int width,
                                            const gl::Scissor& bounds) {
  std::map<std::uint32_t, Extent> extents;
  std::uint32_t lastWord = 0;
  Extent* lastExtent = nullptr;
  for (int y = bounds.y; y < bounds.y + bounds.height; ++y)
    for (int x = bounds.x; x < bounds.x + bounds.width; ++x) {
      const std::uint32_t word = ids[std::size_t(y) * std::size_t(width) + std::size_t(x)].y;
      if ((word & 0xffffu) == 0) continue;
      if (!lastExtent || word != lastWord) {
        lastExtent = &extents[word];
        lastWord = word;
      }
      lastExtent->x0 = std::min(lastExtent->x0, x);
      lastExtent->x1 = std::max(lastExtent->x1, x);
      lastExtent->y0 = std::min(lastExtent->y0, y);
      lastExtent->y1 = std::max(lastExtent->y1, y);
      ++lastExtent->pixels;
    }
  return extents;
}

}  // namespace

VisibleMirrors ChainFinder::find(const raster::Level& level, const std::vector<raster::Chain>& parents,
                                 int bounces) {
  const int width = level.widthPx;
  ids_.resize(std::size_t(width) * std::size_t(level.heightPx));
  level.surfaces.readPixelsInPlace(3, level.drawnBounds, std::span<uvec2>(ids_));
  VisibleMirrors mirrors;
  for (const auto& [word, extent] : findExtents(ids_, width, level.drawnBounds)) {
    const auto parent = std::find_if(parents.begin(), parents.end(),
                                     [id = word >> 16](const raster::Chain& c) { return c.id == id; });
    const std::uint32_t reflector = (word & 0xffffu) - 1u;
    raster::Chain chain;
    bool isFollowed = parent != parents.end() && lastChain_ + 1 < kMaxChains;
    if (isFollowed) {
      chain = raster::extendChain(*parent, reflector, world_);
      isFollowed = chain.crossings <= scene::kMostCrossings && chain.level - chain.crossings <= bounces;
    } else {
      chain.parent = word >> 16;
      chain.last = reflector;
    }
    chain.id = isFollowed ? ++lastChain_ : kMaxChains;
    chain.bounds = {extent.x0, extent.y0, extent.x1 - extent.x0 + 1, extent.y1 - extent.y0 + 1};
    chain.pixels = extent.pixels;
    (isFollowed ? mirrors.chains : mirrors.unfollowed).push_back(chain);
  }
  return mirrors;
}

}  // namespace catoptric::renderer
