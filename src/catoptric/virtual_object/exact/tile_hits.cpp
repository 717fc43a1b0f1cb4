// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/tile_hits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kBlockEdge = 32;           // what a core takes at a time
constexpr int kTileEdge = 8;             // eight lanes a row
constexpr int kSmallEdge = 4;            // tiles are cut no further unless their rays have no shaft
constexpr double kWide = 0.2;            // a shaft that spreads more opens too many boxes for all its rays
constexpr std::size_t kStackSize = 128;  // of the traversal: the hierarchy's builder bounds its depth
constexpr float kFarthest = 0.9999999f;  // depth, as in exact_hit.frag

void note(std::uint32_t part, std::vector<std::uint32_t>& parts) {
  if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
}

void clear(Cover& cover) {
  cover.opaque.clear();
  cover.masked.clear();
  cover.blended.clear();
  cover.parts.clear();
  cover.offeredPixels = 0;
}

void append(const Cover& from, Cover& to) {
  to.masked.insert(to.masked.end(), from.masked.begin(), from.masked.end());
  to.blended.insert(to.blended.end(), from.blended.begin(), from.blended.end());
  to.parts.insert(to.parts.end(), from.parts.begin(), from.parts.end());
  to.offeredPixels += from.offeredPixels;
}

}  // namespace

void TileHits::compute(const RayImages& rays, const CoverQuery& query, float depthFromDistance, Cover& cover,
                       HitImage& image) {
  clear(cover);
  const std::size_t pixels = std::size_t(query.width) * std::size_t(query.height);
  image.hits.assign(pixels, uvec2(0u));
  image.depths.assign(pixels, 1.0f);
  if (hierarchy_.nodes().empty()) return;
  const int x0 = query.x / kBlockEdge, y0 = query.y / kBlockEdge;
  const int columns = (query.x + query.width - 1) / kBlockEdge - x0 + 1,
            rows = (query.y + query.height - 1) / kBlockEdge - y0 + 1;
  const auto count = std::size_t(columns) * std::size_t(rows);
  if (blocks_.size() < count) blocks_.resize(count);
  const Job job{rays, query, depthFromDistance, image};
  core::parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      clear(blocks_[i].cover);
      const int x = (x0 + int(i) % columns) * kBlockEdge, y = (y0 + int(i) / columns) * kBlockEdge;
      for (int dy = 0; dy < kBlockEdge; dy += kTileEdge)
        for (int dx = 0; dx < kBlockEdge; dx += kTileEdge)
          findHits(job, {x + dx, y + dy, kTileEdge}, blocks_[i]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) append(blocks_[i].cover, cover);
}

void TileHits::findHits(const Job& job, const Tile& tile, Block& block) const {
  // 1
  if (!gatherRays(job, tile, block)) return;
  const std::optional<RayShaft> shaft = RayShaft::find({block.origins, block.directions}, job.query.reach);
  if (shaft && (tile.edge <= kSmallEdge || shaft->spread() < kWide)) {
    openBoxes(job, *shaft, block);
    block.parts.clear();
    writeHits(job, block);
    emitDoubtful(tile, job, block);
    return;
  }
  const int half = tile.edge / 2;  // 0: one ray without a direction
  for (int quarter = 0; half > 0 && quarter < 4; ++quarter)
    findHits(job, {tile.x + (quarter & 1) * half, tile.y + (quarter >> 1) * half, half}, block);
}

bool TileHits::gatherRays(const Job& job, const Tile& tile, Block& block) {
  const CoverQuery& q = job.query;
  block.origins.clear();
  block.directions.clear();
  block.pixels.clear();
  const int x0 = std::max(tile.x, q.x), x1 = std::min(tile.x + tile.edge, q.x + q.width);
  const int y0 = std::max(tile.y, q.y), y1 = std::min(tile.y + tile.edge, q.y + q.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(job.rays.widthPx) + std::size_t(x);
      if (job.rays.words[i].y != q.word) continue;
      block.origins.push_back(job.rays.origins[i]);
      block.directions.push_back(job.rays.directions[i]);
      block.pixels.push_back(std::uint32_t((y - q.y) * q.width + (x - q.x)));
    }
  return !block.origins.empty();
}

void TileHits::openBoxes(const Job& job, const RayShaft& shaft, Block& block) const {
  // 2
  struct Box {
    std::uint32_t node;
    double nearest;
  };
  const std::span<const TriangleHierarchy::Node> nodes = hierarchy_.nodes();
  const auto open = [&](std::uint32_t node) {
    return Box{node, shaft.findNearest(nodes[node].lower, nodes[node].upper)};
  };
  block.lanes.assign(block.origins, block.directions);
  block.doubtful.clear();
  double hiddenFrom = std::numeric_limits<double>::infinity();  // height: a ray that begins late is hit
                                                                // farther up than it is long
  std::array<Box, kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = open(0);
  while (top > 0) {
    const Box box = stack[--top];
    if (!(box.nearest < hiddenFrom)) continue;
    const TriangleHierarchy::Node& node = nodes[box.node];
    if (node.count > 0) {
      hiddenFrom = double(testLeaf(job, shaft, node, block)) + shaft.latestStart();
      continue;
    }
    Box nearer = open(box.node + 1), farther = open(node.first);
    if (farther.nearest < nearer.nearest) std::swap(nearer, farther);
    if (farther.nearest < hiddenFrom) stack[top++] = farther;
    if (nearer.nearest < hiddenFrom) stack[top++] = nearer;  // pushed last, so looked at first
  }
  std::erase_if(block.doubtful, [&](const Doubtful& d) { return double(d.nearest) > hiddenFrom; });
}

float TileHits::testLeaf(const Job& job, const RayShaft& shaft, const TriangleHierarchy::Node& leaf,
                         Block& block) const {
  // 3
  block.tests.clear();
  for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
    const HierarchyTriangle& t = hierarchy_.triangles()[i];
    if (t.part == job.query.excludedPart) continue;
    const bool isSingleSided = (t.flags & kCoverSingleSided) != 0;
    if ((t.flags & (kCoverMasked | kCoverBlended)) != 0) {
      if (const auto hit = shaft.mayMeet(t.a, t.b, t.c, isSingleSided))
        block.doubtful.push_back({i, float(hit->nearest)});
      continue;
    }
    block.tests.push_back(
        {t.a, t.b, t.c, glm::cross(t.b - t.a, t.c - t.a), i, isSingleSided, t.part == job.query.ownPart});
  }
  block.cover.offeredPixels += block.tests.size() * block.pixels.size();
  return block.lanes.meet(block.tests);
}

void TileHits::writeHits(const Job& job, Block& block) const {
  for (std::size_t ray = 0; ray < block.pixels.size(); ++ray) {
    const std::uint32_t index = block.lanes.triangle(ray);
    if (index == core::kNoId) continue;
    const HierarchyTriangle& t = hierarchy_.triangles()[index];
    const float distance = block.lanes.distance(ray);
    job.image.hits[block.pixels[ray]] = uvec2(t.triangle + 1, std::bit_cast<std::uint32_t>(distance));
    job.image.depths[block.pixels[ray]] = std::min(distance * job.depthFromDistance, kFarthest);
    note(t.part, block.parts);
  }
}

void TileHits::emitDoubtful(const Tile& tile, const Job& job, Block& block) const {
  const CoverQuery& q = job.query;
  const int x0 = std::max(tile.x, q.x), x1 = std::min(tile.x + tile.edge, q.x + q.width);
  const int y0 = std::max(tile.y, q.y), y1 = std::min(tile.y + tile.edge, q.y + q.height);
  CoverRect rect{std::uint16_t(x0), std::uint16_t(y0), std::uint16_t(x1 - x0), std::uint16_t(y1 - y0), 0};
  for (const Doubtful& doubtful : block.doubtful) {
    const HierarchyTriangle& t = hierarchy_.triangles()[doubtful.index];
    rect.item = t.triangle;
    if ((t.flags & kCoverBlended) != 0) {
      block.cover.blended.push_back(rect);
      continue;
    }
    block.cover.masked.push_back(rect);
    block.cover.offeredPixels += std::uint64_t(rect.width) * rect.height;
    note(t.part, block.parts);
  }
  for (const std::uint32_t part : block.parts) {
    rect.item = part;
    block.cover.parts.push_back(rect);
  }
}

}  // namespace catoptric::virtual_object
