// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/part_rects.h"

#include <algorithm>
#include <bit>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kBlockEdge = 4, kTileBlocks = 8, kTileEdge = kBlockEdge * kTileBlocks;

/// Blocks of a tile in which a part is seen, a bit each, row by row.
struct PartBlocks {
  std::uint32_t part;
  std::uint64_t inner, edges;
};

/// What findPartRects() looks at.
struct HitImage {
  std::span<const std::uint32_t> triangleParts;
  const gl::Scissor& bounds;
  std::span<const uvec2> hits, parentIds;
  int widthPx;
  std::uint32_t parentWord;

  [[nodiscard]] const uvec2* hitRow(int y) const {
    return hits.data() + std::ptrdiff_t(y - bounds.y) * bounds.width - bounds.x;
  }
  [[nodiscard]] const uvec2* idRow(int y) const { return parentIds.data() + std::ptrdiff_t(y) * widthPx; }
  [[nodiscard]] gl::Scissor cut(int x, int y, int width, int height) const {
    const int x0 = std::max(x, bounds.x), y0 = std::max(y, bounds.y);
    const int x1 = std::min(x + width, bounds.x + bounds.width);
    const int y1 = std::min(y + height, bounds.y + bounds.height);
    return {x0, y0, x1 - x0, y1 - y0};
  }
};

/// The parts of one tile.
class TileParts {
 public:
  void clear() {
    parts_.clear();
    lastHit_ = 0;
    rest_ = 0;
  }
  /// Blocks with pixels of the mirror at which no part is seen.
  [[nodiscard]] std::uint64_t rest() const { return rest_; }
  [[nodiscard]] std::span<const PartBlocks> parts() const { return parts_; }

  void addBlock(const HitImage& image, int x, int y, std::uint64_t bit) {
    const gl::Scissor b = image.cut(x, y, kBlockEdge, kBlockEdge);
    bool isInner = b.width == kBlockEdge && b.height == kBlockEdge;
    for (int py = b.y; isInner && py < b.y + b.height; ++py) {
      const uvec2* ids = image.idRow(py);
      for (int px = b.x; px < b.x + b.width; ++px) isInner = isInner && ids[px].y == image.parentWord;
    }
    for (int py = b.y; py < b.y + b.height; ++py) {
      const uvec2 *ids = image.idRow(py), *hits = image.hitRow(py);
      for (int px = b.x; px < b.x + b.width; ++px) {
        const std::uint32_t hit = hits[px].x;
        if (!isInner && ids[px].y != image.parentWord) continue;
        if (hit == 0) {
          rest_ |= bit;
          continue;
        }
        PartBlocks& blocks = find(image, hit);
        (isInner ? blocks.inner : blocks.edges) |= bit;
      }
    }
  }

 private:
  PartBlocks& find(const HitImage& image, std::uint32_t hit) {
    if (hit == lastHit_) return parts_[last_];
    const std::uint32_t part = image.triangleParts[hit - 1];
    lastHit_ = hit;
    for (last_ = 0; last_ < parts_.size(); ++last_)
      if (parts_[last_].part == part) return parts_[last_];
    return parts_.emplace_back(PartBlocks{part, 0, 0});
  }

  std::vector<PartBlocks> parts_;
  std::uint64_t rest_ = 0;
  std::uint32_t lastHit_ = 0;  ///< and where its part is
  std::size_t last_ = 0;
};

/// Blocks to rectangles: the first row's first run of blocks, as far down as all of it goes on.
void addRects(const HitImage& image, std::uint64_t blocks, int x0, int y0, std::uint32_t part,
              std::vector<CoverRect>& rects) {
  while (blocks != 0) {
    const int first = std::countr_zero(blocks), row = first / kTileBlocks, column = first % kTileBlocks;
    const auto ofRow = [&](int r) { return unsigned(blocks >> (r * kTileBlocks)) & 0xffu; };
    const int count = std::countr_one(ofRow(row) >> column);
    const unsigned run = ((1u << count) - 1u) << column;
    int last = row;
    for (; last < kTileBlocks && (ofRow(last) & run) == run; ++last)
      blocks &= ~(std::uint64_t(run) << (last * kTileBlocks));
    const gl::Scissor r = image.cut(x0 + column * kBlockEdge, y0 + row * kBlockEdge, count * kBlockEdge,
                                    (last - row) * kBlockEdge);
    rects.push_back(
        {std::uint16_t(r.x), std::uint16_t(r.y), std::uint16_t(r.width), std::uint16_t(r.height), part});
  }
}

/// The box around a tile's blocks; joined to the last one if that ends where the tile begins.
void addBox(const HitImage& image, std::uint64_t blocks, int x0, int y0, std::vector<gl::Scissor>& boxes) {
  if (blocks == 0) return;
  std::uint64_t columns = blocks;
  for (const int rows : {4, 2, 1}) columns |= columns >> (rows * kTileBlocks);
  columns &= 0xffu;
  const int left = std::countr_zero(columns), right = std::bit_width(columns);
  const int low = std::countr_zero(blocks) / kTileBlocks,
            high = (std::bit_width(blocks) - 1) / kTileBlocks + 1;
  gl::Scissor box = image.cut(x0 + left * kBlockEdge, y0 + low * kBlockEdge, (right - left) * kBlockEdge,
                              (high - low) * kBlockEdge);
  if (!boxes.empty() && boxes.back().x + boxes.back().width == box.x) {
    gl::Scissor& last = boxes.back();
    const int y = std::min(last.y, box.y);
    last.height = std::max(last.y + last.height, box.y + box.height) - y;
    last.y = y;
    last.width += box.width;
  } else {
    boxes.push_back(box);
  }
}

void findRowRects(const HitImage& image, int y0, PartRects& rects) {
  rects.inner.clear(), rects.edges.clear(), rects.rest.clear();
  const int xEnd = image.bounds.x + image.bounds.width;
  TileParts tile;
  for (int x0 = image.bounds.x / kTileEdge * kTileEdge; x0 < xEnd; x0 += kTileEdge) {
    tile.clear();
    for (int k = 0; k < kTileBlocks * kTileBlocks; ++k) {
      const int x = x0 + k % kTileBlocks * kBlockEdge, y = y0 + k / kTileBlocks * kBlockEdge;
      tile.addBlock(image, x, y, std::uint64_t(1) << k);
    }
    addBox(image, tile.rest(), x0, y0, rects.rest);
    for (const PartBlocks& blocks : tile.parts()) {
      addRects(image, blocks.inner, x0, y0, blocks.part, rects.inner);
      addRects(image, blocks.edges, x0, y0, blocks.part, rects.edges);
    }
  }
}

}  // namespace

void findPartRects(std::span<const std::uint32_t> triangleParts, const gl::Scissor& bounds,
                   std::span<const uvec2> hits, std::span<const uvec2> parentIds, int widthPx,
                   std::uint32_t parentWord, PartRects& rects) {
  const HitImage image{triangleParts, bounds, hits, parentIds, widthPx, parentWord};
  const int firstRow = bounds.y / kTileEdge, rowEnd = (bounds.y + bounds.height + kTileEdge - 1) / kTileEdge;
  rects.rows.resize(std::size_t(rowEnd - firstRow));
  core::parallelFor(rects.rows.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      findRowRects(image, (firstRow + int(i)) * kTileEdge, rects.rows[i]);
  });
  rects.inner.clear(), rects.edges.clear(), rects.rest.clear();
  for (const PartRects& row : rects.rows) {
    rects.inner.insert(rects.inner.end(), row.inner.begin(), row.inner.end());
    rects.edges.insert(rects.edges.end(), row.edges.begin(), row.edges.end());
    rects.rest.insert(rects.rest.end(), row.rest.begin(), row.rest.end());
  }
  const auto byPart = [](const CoverRect& a, const CoverRect& b) { return a.item < b.item; };
  std::stable_sort(rects.inner.begin(), rects.inner.end(), byPart);
  std::stable_sort(rects.edges.begin(), rects.edges.end(), byPart);
}

}  // namespace catoptric::virtual_object
