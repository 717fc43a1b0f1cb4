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

using geometry::HierarchyTriangle;
using geometry::TriangleHierarchy;

constexpr int kBlockEdge = 32;           // what a core takes at a time
constexpr int kTileEdge = 8;             // eight lanes a row
constexpr int kSmallEdge = 4;            // tiles are cut no further unless their rays have no shaft
constexpr double kWide = 0.2;            // a shaft that spreads more opens too many boxes for all its rays
constexpr std::size_t kStackSize = 128;  // of the traversal: the hierarchy's builder bounds its depth
constexpr float kFarthest = 0.9999999f;  // depth, as in exact_hit.frag

}  // namespace

void TileHits::compute(const RayImages& rays, const CoverQuery& query, float depthFromDistance, Cover& cover,
                       HitImage& image) {
  cover.clear();
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
      blocks_[i].cover.clear();
      const int x = (x0 + int(i) % columns) * kBlockEdge, y = (y0 + int(i) / columns) * kBlockEdge;
      for (int dy = 0; dy < kBlockEdge; dy += kTileEdge)
        for (int dx = 0; dx < kBlockEdge; dx += kTileEdge)
          findHits(job, {x + dx, y + dy, kTileEdge}, blocks_[i]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) cover.append(blocks_[i].cover);
}

void TileHits::findHits(const Job& job, const MirrorTile& tile, Block& block) const {
  // 1
  if (!block.rays.gather(job.rays, job.query, tile)) return;
  const std::optional<RayShaft> shaft =
      RayShaft::find({block.rays.origins, block.rays.directions}, job.query.reach);
  if (shaft && (tile.edge <= kSmallEdge || shaft->spread() < kWide)) {
    openBoxes(job, *shaft, block);
    block.parts.clear();
    writeHits(job, block);
    emitDoubtful(job, tile, block);
    return;
  }
  if (tile.edge == 1) return;  // one ray without a direction
  for (int k = 0; k < 4; ++k) findHits(job, tile.quarter(k), block);
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
  block.lanes.assign(block.rays.origins, block.rays.directions);
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
  block.cover.offeredPixels += block.tests.size() * block.rays.pixels.size();
  return block.lanes.meet(block.tests);
}

void TileHits::writeHits(const Job& job, Block& block) const {
  for (std::size_t ray = 0; ray < block.rays.pixels.size(); ++ray) {
    const std::uint32_t index = block.lanes.triangle(ray);
    if (index == core::kNoId) continue;
    const HierarchyTriangle& t = hierarchy_.triangles()[index];
    const float distance = block.lanes.distance(ray);
    job.image.hits[block.rays.pixels[ray]] = uvec2(t.triangle + 1, std::bit_cast<std::uint32_t>(distance));
    job.image.depths[block.rays.pixels[ray]] = std::min(distance * job.depthFromDistance, kFarthest);
    notePart(t.part, block.parts);
  }
}

void TileHits::emitDoubtful(const Job& job, const MirrorTile& tile, Block& block) const {
  CoverRect rect = tile.within(job.query);
  for (const Doubtful& doubtful : block.doubtful) {
    const HierarchyTriangle& t = hierarchy_.triangles()[doubtful.index];
    rect.item = t.triangle;
    if ((t.flags & kCoverBlended) != 0) {
      block.cover.blended.push_back(rect);
      continue;
    }
    block.cover.masked.push_back(rect);
    block.cover.offeredPixels += std::uint64_t(rect.width) * rect.height;
    notePart(t.part, block.parts);
  }
  for (const std::uint32_t part : block.parts) {
    rect.item = part;
    block.cover.parts.push_back(rect);
  }
}

}  // namespace catoptric::virtual_object
