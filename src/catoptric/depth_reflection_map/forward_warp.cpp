// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/forward_warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

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

/// Step 3, pixels [first, end): the later layer wins, or the nearer. The layer is empty afterwards.
void overlayRow(WinnerImage& later, std::size_t first, std::size_t end, WinnerImage& image) {
  std::uint32_t *const from = later.winners.data(), *const to = image.winners.data();
  if (image.nearness.empty()) {
    for (std::size_t i = first; i < end; ++i) to[i] = from[i] != 0 ? from[i] : to[i];
  } else {
    for (std::size_t i = first; i < end; ++i)
      if (later.nearness[i] > image.nearness[i]) {
        image.nearness[i] = later.nearness[i];
        to[i] = from[i];
      }
    std::fill(&later.nearness[first], later.nearness.data() + end, -1.0f);
  }
  std::fill(from + first, from + end, 0u);
}

void overlay(WinnerImage& later, WinnerImage& image) {
  if (later.written.isEmpty()) return;
  const PixelBox box = later.written;
  core::parallelFor(
      std::size_t(box.upper.y) + 1 - std::size_t(box.lower.y), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const std::size_t start = (std::size_t(box.lower.y) + row) * std::size_t(image.stride);
          overlayRow(later, start + std::size_t(box.lower.x), start + std::size_t(box.upper.x) + 1, image);
        }
      });
  image.written.include(box);
  later.written = {};
}

/// Calls warpTiles(from, to) for stretches of visible tiles of [first, end), as long as one chunk may be.
template <class WarpTiles>
void forVisibleTiles(const std::uint8_t* visible, int first, int end, bool leftToRight,
                     const WarpTiles& warpTiles) {
  constexpr int kMost = kMostZexels / kZexelTile;
  if (leftToRight) {
    for (int from = first; from < end;) {
      int to = from;
      while (to < end && to - from < kMost && visible[to]) ++to;
      if (to > from) warpTiles(from, to);
      from = to > from ? to : from + 1;
    }
  } else {
    for (int to = end; to > first;) {
      int from = to;
      while (from > first && to - from < kMost && visible[from - 1]) --from;
      if (to > from) warpTiles(from, to);
      to = to > from ? from : to - 1;
    }
  }
}

}  // namespace

void WinnerImage::reset(const PixelRectangle& bounds, bool withNearness) {
  resize(bounds, withNearness);
  std::fill(winners.begin(), winners.end(), 0u);
  std::fill(nearness.begin(), nearness.end(), -1.0f);
  written = {};
}

void WinnerImage::resize(const PixelRectangle& bounds, bool withNearness) {
  rectangle = bounds;
  stride = bounds.width + 2 * kBorder;
  rows = bounds.height + 2 * kBorder;
  const std::size_t count = std::size_t(stride) * std::size_t(rows);
  winners.resize(count);
  nearness.resize(withNearness ? count : 0);
}

void ForwardWarp::findVisibleTiles(const ZexelLevel& level, const Setup& setup, const WinnerImage& image,
                                   bool skips) {
  visibleTiles_.assign(level.tiles.size(), 1);
  visibleBefore_.resize(std::size_t(level.tileColumns + 1) * std::size_t(level.tileRows));
  std::size_t i = 0, k = 0;
  for (int row = 0; row < level.tileRows; ++row) {
    std::uint32_t before = 0;
    for (int column = 0; column < level.tileColumns; ++column, ++i) {
      const double edge = double(kZexelTile) * level.step;
      const dvec3 lower(column * edge, row * edge, level.tiles[i].least);
      const dvec3 upper((column + 1) * edge, (row + 1) * edge, level.tiles[i].largest);
      if (skips)
        visibleTiles_[i] =
            mayBeVisible(setup.pixelFromZexel, setup.perDisparity, lower, upper, image) ? 1 : 0;
      visibleBefore_[k++] = before;
      before += visibleTiles_[i] * std::uint32_t(kZexelTile);
    }
    visibleBefore_[k++] = before;
  }
}

/// To within a tile for each row.
std::uint64_t ForwardWarp::countVisible(const ZexelLevel& level, const Sheet& sheet) const {
  std::uint64_t count = 0;
  for (const ZexelRun& run : order_.runs(sheet)) {
    const std::uint32_t* before =
        &visibleBefore_[std::size_t(run.y / kZexelTile) * std::size_t(level.tileColumns + 1)];
    const int first = run.begin / kZexelTile, last = (run.end - 1) / kZexelTile;
    count += std::min(before[last + 1] - before[first], std::uint32_t(run.end - run.begin));
  }
  return count;
}

/// Contiguous sheets to each thread, about equally much work; the first has the picture to clear, which takes
/// as long as some zexels.
void ForwardWarp::shareSheets(const ZexelLevel& level, std::size_t threads, std::uint64_t clearing) {
  const std::size_t count = order_.sheets().size();
  std::vector<std::uint64_t>& work = sheetWork_;
  work.resize(count);
  std::uint64_t all = clearing, done = clearing;
  for (std::size_t i = 0; i < count; ++i) all += work[i] = countVisible(level, order_.sheets()[i]);
  firstSheets_.assign(1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    while (firstSheets_.size() < threads && (done + work[i] / 2) * threads > all * firstSheets_.size())
      firstSheets_.push_back(i);
    done += work[i];
  }
  firstSheets_.resize(threads, count);
  firstSheets_.push_back(count);
}

namespace {

/// Zexels [begin, end) of row y of a level. The last column and row look back instead of ahead.
ZexelChunk makeChunk(const ZexelLevel& level, const dmat3& pixelFromZexel, int y, int begin, int end) {
  ZexelChunk chunk;
  chunk.here = level.disparities.data() + std::size_t(y) * std::size_t(level.width) + begin;
  const bool looksBack = end == level.width, looksDown = y + 1 == level.height;
  const bool isLoneColumn = looksBack && begin == 0, isLoneRow = level.height == 1;
  chunk.next = chunk.here + (isLoneColumn ? 0 : looksBack ? -1 : 1);
  chunk.above = chunk.here + (isLoneRow ? 0 : looksDown ? -level.width : level.width);
  chunk.nextSign = looksBack ? -1.0f : 1.0f;
  chunk.aboveSign = looksDown ? -1.0f : 1.0f;
  chunk.count = end - begin;
  chunk.firstAtPixel = vec3(pixelFromZexel * dvec3(level.base(begin) + 0.5, level.base(y) + 0.5, 1.0));
  return chunk;
}

}  // namespace

std::uint64_t ForwardWarp::warpSheets(const ZexelLevel& level, const Setup& setup, std::size_t first,
                                      std::size_t last, const WarpOptions& options, WinnerImage& out) const {
  const ZexelWarp warp{
      mat3(setup.pixelFromZexel),     vec3(setup.perDisparity), float(level.step), out.stride, out.rows,
      float(WinnerImage::kBorder) / 2};
  std::uint64_t count = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Sheet& sheet = order_.sheets()[i];
    for (const ZexelRun& run : order_.runs(sheet)) {
      const std::uint8_t* visible =
          &visibleTiles_[std::size_t(run.y / kZexelTile) * std::size_t(level.tileColumns)];
      const int firstTile = run.begin / kZexelTile, endTile = (run.end - 1) / kZexelTile + 1;
      const auto warpTiles = [&](int from, int to) {
        const int begin = std::max(run.begin, from * kZexelTile), end = std::min(run.end, to * kZexelTile);
        const std::uint32_t winner = std::uint32_t(level.base(run.y)) * std::uint32_t(setup.mapWidth) +
                                     std::uint32_t(level.base(begin)) + 1u;
        splatZexels(makeChunk(level, setup.pixelFromZexel, run.y, begin, end), warp,
                    {winner | setup.tagBits, std::uint32_t(level.step), sheet.leftToRight}, options.splat,
                    out);
        count += std::uint64_t(end - begin);
      };
      forVisibleTiles(visible, firstTile, endTile, sheet.leftToRight, warpTiles);
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

  // 2
  out.resize(rectangle, options.visibility == Visibility::ZBuffer);
  findVisibleTiles(level, setup, out, options.skipsRegions);

  // 3
  constexpr std::uint64_t kClearedPerZexel = 32;
  const std::size_t threads = std::clamp<std::size_t>(std::size_t(core::threadCount()), 1, kMostThreads);
  shareSheets(level, threads, out.winners.size() / kClearedPerZexel);
  layers_.resize(threads - 1);
  std::array<std::uint64_t, kMostThreads> counts{};
  core::parallelFor(threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      WinnerImage& layer = i == 0 ? out : layers_[i - 1];
      if (i == 0 || !layer.hasLayoutOf(out))
        layer.reset(rectangle, options.visibility == Visibility::ZBuffer);
      counts[i] = warpSheets(level, setup, firstSheets_[i], firstSheets_[i + 1], options, layer);
      layer.winners[0] = 0;
    }
  });
  for (WinnerImage& layer : layers_) overlay(layer, out);
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
}

void fillExposures(const WinnerImage& second, WinnerImage& first) {
  assert(second.winners.size() == first.winners.size());
  core::parallelFor(first.winners.size(), 1u << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      first.winners[i] = first.winners[i] != 0 ? first.winners[i] : second.winners[i];
  });
}

}  // namespace catoptric::depth_reflection_map
