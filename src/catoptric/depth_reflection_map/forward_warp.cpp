// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/forward_warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"
#include "catoptric/depth_reflection_map/zexel_splats.h"

namespace catoptric::depth_reflection_map {

/// Step 1 for one map and view, in pixels of the winner image with its border.
struct ForwardWarp::Setup {
  dmat3 pixelFromZexel;  ///< of level 0
  dvec3 perDisparity;
  std::uint32_t tagBits;
  int mapWidth;
};

namespace {

constexpr std::size_t kMostThreads = 16;

/// Step 2: can the image of a box of (column, row, disparity) touch the winner image?
bool mayBeVisible(const dmat3& pixelFromZexel, const dvec3& perDisparity, const dvec3& lower,
                  const dvec3& upper, const WinnerImage& image) {
  dvec2 least(1e300), largest(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                  corner & 4 ? upper.z : lower.z);
    const dvec3 h = pixelFromZexel * dvec3(p.x, p.y, 1.0) + p.z * perDisparity;
    if (h.z <= 1e-9) return true;  // reaches behind the eye: no bound
    least = glm::min(least, dvec2(h) / h.z);
    largest = glm::max(largest, dvec2(h) / h.z);
  }
  constexpr int kHalfBorder = WinnerImage::kBorder / 2;
  constexpr double kReach = kHalfBorder;
  return largest.x > kReach && largest.y > kReach && least.x < image.stride - kReach &&
         least.y < image.rows - kReach;
}

/// Step 3: the later layer wins, or the nearer.
void overlay(const WinnerImage& later, WinnerImage& image) {
  const bool byNearness = !image.nearness.empty();
  core::parallelFor(image.winners.size(), 1u << 16, [&](std::size_t begin, std::size_t end) {
    if (byNearness) {
      for (std::size_t i = begin; i < end; ++i)
        if (later.nearness[i] > image.nearness[i]) {
          image.winners[i] = later.winners[i];
          image.nearness[i] = later.nearness[i];
        }
    } else {
      for (std::size_t i = begin; i < end; ++i)
        image.winners[i] = later.winners[i] != 0 ? later.winners[i] : image.winners[i];
    }
  });
}

}  // namespace

void WinnerImage::reset(const PixelRectangle& bounds, bool withNearness) {
  rectangle = bounds;
  stride = bounds.width + 2 * kBorder;
  rows = bounds.height + 2 * kBorder;
  const std::size_t count = std::size_t(stride) * std::size_t(rows);
  winners.assign(count, 0u);
  if (withNearness)
    nearness.assign(count, -1.0f);
  else
    nearness.clear();
}

void ForwardWarp::findVisibleTiles(const ZexelLevel& level, const Setup& setup, bool skips) {
  visibleTiles_.assign(level.tiles.size(), 1);
  if (!skips) return;
  const WinnerImage& image = layers_.front();
  for (int row = 0; row < level.tileRows; ++row)
    for (int column = 0; column < level.tileColumns; ++column) {
      const std::size_t i = std::size_t(row) * std::size_t(level.tileColumns) + std::size_t(column);
      const double edge = double(kZexelTile) * level.step;
      const dvec3 lower(column * edge, row * edge, level.tiles[i].least);
      const dvec3 upper((column + 1) * edge, (row + 1) * edge, level.tiles[i].largest);
      visibleTiles_[i] = mayBeVisible(setup.pixelFromZexel, setup.perDisparity, lower, upper, image) ? 1 : 0;
    }
}

std::uint64_t ForwardWarp::warpSheets(const ZexelLevel& level, const Setup& setup, std::size_t first,
                                      std::size_t last, const WarpOptions& options, WinnerImage& out) const {
  const std::uint32_t columnStep = std::uint32_t(level.step);
  const ZexelWarp warp{mat3(setup.pixelFromZexel), vec3(setup.perDisparity), float(level.step)};
  std::uint64_t count = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Sheet& sheet = order_.sheets()[i];
    for (const ZexelRun& run : order_.runs(sheet)) {
      const std::uint8_t* visible =
          &visibleTiles_[std::size_t(run.y / kZexelTile) * std::size_t(level.tileColumns)];
      const int firstTile = run.begin / kZexelTile, lastTile = (run.end - 1) / kZexelTile;
      for (int k = 0; k <= lastTile - firstTile; ++k) {
        const int tile = sheet.leftToRight ? firstTile + k : lastTile - k;
        if (!visible[tile]) continue;
        ZexelChunk chunk;
        chunk.y = run.y;
        chunk.begin = std::max(run.begin, tile * kZexelTile);
        chunk.end = std::min(run.end, (tile + 1) * kZexelTile);
        chunk.leftToRight = sheet.leftToRight;
        chunk.firstAtPixel =
            setup.pixelFromZexel * dvec3(level.base(chunk.begin) + 0.5, level.base(chunk.y) + 0.5, 1.0);
        chunk.firstWinner = (std::uint32_t(level.base(chunk.y)) * std::uint32_t(setup.mapWidth) +
                             std::uint32_t(level.base(chunk.begin)) + 1u) |
                            setup.tagBits;
        chunk.winnerStep = columnStep;
        splatChunk(level, warp, chunk, options.splat, out);
        count += std::uint64_t(chunk.end - chunk.begin);
      }
    }
  }
  return count;
}

std::uint64_t ForwardWarp::warp(const ZexelMap& map, const Pinhole& reference, const Pinhole& view,
                                const PixelRectangle& rectangle, std::uint32_t tag,
                                const WarpOptions& options, WinnerImage& out) {
  assert(tag < 4 && options.level >= 0 && options.level < int(map.levels.size()));
  assert(std::uint64_t(map.width) * std::uint64_t(map.height) < kWinnerIndexMask);
  const ZexelLevel& level = map.levels[std::size_t(options.level)];
  // 1
  const dmat3 pixelFromWorld = glm::inverse(view.worldFromPixel);
  dmat3 shift(1.0);
  shift[2] = dvec3(WinnerImage::kBorder - rectangle.x, WinnerImage::kBorder - rectangle.y, 1.0);
  Setup setup{shift * pixelFromWorld * reference.worldFromPixel,
              shift * pixelFromWorld * (reference.centre - view.centre), tag << kWinnerTagShift, map.width};
  const dvec3 epipole = glm::inverse(reference.worldFromPixel) * (view.centre - reference.centre);
  order_.compute(level.width, level.height, dvec3(epipole.x / level.step, epipole.y / level.step, epipole.z));

  const bool withNearness = options.visibility == Visibility::ZBuffer;
  const std::size_t sheetCount = order_.sheets().size();
  const std::size_t threads = std::min({std::size_t(core::threadCount()), sheetCount, kMostThreads});
  if (layers_.size() < threads) layers_.resize(threads);
  for (std::size_t i = 0; i < threads; ++i) layers_[i].reset(rectangle, withNearness);
  // 2
  findVisibleTiles(level, setup, options.skipsRegions);

  // 3. Contiguous sheets to each thread, about equally many zexels.
  const std::uint64_t all = std::uint64_t(level.width) * std::uint64_t(level.height);
  std::array<std::size_t, kMostThreads + 1> firstSheet{};
  std::size_t sheet = 0;
  std::uint64_t seen = 0;
  for (std::size_t i = 1; i <= threads; ++i) {
    while (sheet < sheetCount && seen + order_.sheets()[sheet].zexels / 2 < all * i / threads)
      seen += order_.sheets()[sheet++].zexels;
    firstSheet[i] = i == threads ? sheetCount : sheet;
  }
  std::array<std::uint64_t, kMostThreads> counts{};
  core::parallelFor(threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      counts[i] = warpSheets(level, setup, firstSheet[i], firstSheet[i + 1], options, layers_[i]);
  });
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < threads; ++i) count += counts[i];
  for (std::size_t i = 1; i < threads; ++i) overlay(layers_[i], layers_[0]);
  std::swap(out, layers_[0]);
  return count;
}

void fillExposures(const WinnerImage& second, WinnerImage& first) {
  assert(second.winners.size() == first.winners.size());
  core::parallelFor(first.winners.size(), 1u << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      first.winners[i] = first.winners[i] != 0 ? first.winners[i] : second.winners[i];
  });
}

}  // namespace catoptric::depth_reflection_map
