// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/chain_finder.h"

#include <algorithm>
#include <map>

#include "catoptric/core/parallel.h"

namespace catoptric::renderer {
namespace {

constexpr std::uint32_t kMaxChains = 4096;  // ids have 16 bits for a chain

constexpr int kRowsEach = 16, kColumnsEach = 4;

using Extent = ChainFinder::Extent;

void addTo(std::map<std::uint32_t, Extent>& extents, std::uint32_t word, const Extent& more) {
  const auto [at, isNew] = extents.try_emplace(word, more);
  if (isNew) return;
  Extent& e = at->second;
  e = {std::min(e.x0, more.x0), std::min(e.y0, more.y0), std::max(e.x1, more.x1), std::max(e.y1, more.y1),
       e.pixels + more.pixels};
}

/// A part of each of some rows.
struct Columns {
  int begin, end;
};

/// Which columns of rows [y0, y1) the rectangles touch, in order and apart.
void findColumns(std::span<const gl::Scissor> rects, int y0, int y1, std::vector<Columns>& columns) {
  columns.clear();
  for (const gl::Scissor& rect : rects)
    if (rect.y < y1 && rect.y + rect.height > y0) columns.push_back({rect.x, rect.x + rect.width});
  std::sort(columns.begin(), columns.end(),
            [](const Columns& a, const Columns& b) { return a.begin < b.begin; });
  std::size_t count = 0;
  for (const Columns& more : columns) {
    if (count > 0 && more.begin <= columns[count - 1].end)
      columns[count - 1].end = std::max(columns[count - 1].end, more.end);
    else
      columns[count++] = more;
  }
  columns.resize(count);
}

/// Adds all mirrors within `bounds`, not many rows; `isShown` is scratch.
void searchRows(std::span<const uvec2> ids, int width, const gl::Scissor& bounds,
                std::vector<std::uint8_t>& isShown, ChainFinder::Rows& rows) {
  const int xEnd = bounds.x + bounds.width;
  isShown.assign(std::size_t(xEnd / kColumnsEach) + 2, 0);
  for (int y = bounds.y; y < bounds.y + bounds.height; ++y) {
    const uvec2* row = ids.data() + std::ptrdiff_t(y) * width;
    for (int x = bounds.x; x < xEnd;) {
      const std::uint32_t word = row[x].y;
      const int first = x;
      while (x < xEnd && row[x].y == word) ++x;
      if ((word & 0xffffu) == 0) continue;
      addTo(rows.extents, word, {first, y, x - 1, y, std::uint64_t(x - first)});
      std::fill(isShown.begin() + first / kColumnsEach, isShown.begin() + (x - 1) / kColumnsEach + 1, 1);
    }
  }
  for (std::size_t i = 0; i < isShown.size(); ++i) {
    if (!isShown[i]) continue;
    const std::size_t first = i;
    while (isShown[i]) ++i;
    const int x0 = std::max(int(first) * kColumnsEach, bounds.x), x1 = std::min(int(i) * kColumnsEach, xEnd);
    rows.rects.push_back({x0, bounds.y, x1 - x0, bounds.height});
  }
}

/// To whole blocks of `all`.
gl::Scissor roundOut(const gl::Scissor& rect, const gl::Scissor& all) {
  const int y0 = std::max(rect.y / kRowsEach * kRowsEach, all.y),
            y1 = std::min((rect.y + rect.height + kRowsEach - 1) / kRowsEach * kRowsEach, all.y + all.height);
  const int x0 = std::max(rect.x / kColumnsEach * kColumnsEach, all.x),
            x1 = std::min((rect.x + rect.width + kColumnsEach - 1) / kColumnsEach * kColumnsEach,
                          all.x + all.width);
  return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
}

}  // namespace

void ChainFinder::readIds(const raster::Level& level, std::span<const gl::Scissor> rects) {
  ids_.resize(std::size_t(level.widthPx) * std::size_t(level.heightPx));
  rects_.clear();
  for (const gl::Scissor& rect : rects) {
    const gl::Scissor rounded = roundOut(rect, level.drawnBounds);
    if (rounded.width == 0 || rounded.height == 0) continue;
    rects_.push_back(rounded);
    level.surfaces.readPixelsInPlace(3, rounded, std::span<uvec2>(ids_));
  }
}

VisibleMirrors ChainFinder::find(const raster::Level& level, const std::vector<raster::Chain>& parents,
                                 int bounces, std::span<const gl::Scissor> rects) {
  const int width = level.widthPx;
  const gl::Scissor& all = level.drawnBounds;
  readIds(level, rects.empty() ? std::span(&all, 1) : rects);
  // Rows of pixels that rasterizers draw together.
  const int firstRow = all.y / kRowsEach, rowEnd = (all.y + all.height + kRowsEach - 1) / kRowsEach;
  rows_.resize(std::size_t(std::max(rowEnd - firstRow, 0)));
  core::parallelFor(rows_.size(), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> isShown;
    std::vector<Columns> columns;
    for (std::size_t i = begin; i < end; ++i) {
      const int y0 = std::max((firstRow + int(i)) * kRowsEach, all.y);
      const int y1 = std::min((firstRow + int(i) + 1) * kRowsEach, all.y + all.height);
      rows_[i].extents.clear(), rows_[i].rects.clear();
      findColumns(rects_, y0, y1, columns);
      for (const Columns& c : columns)
        searchRows(ids_, width, {c.begin, y0, c.end - c.begin, y1 - y0}, isShown, rows_[i]);
    }
  });
  VisibleMirrors mirrors;
  std::map<std::uint32_t, Extent> extents;
  for (const Rows& rows : rows_) {
    for (const auto& [word, extent] : rows.extents) addTo(extents, word, extent);
    mirrors.rects.insert(mirrors.rects.end(), rows.rects.begin(), rows.rects.end());
  }
  for (const auto& [word, extent] : extents) {
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
