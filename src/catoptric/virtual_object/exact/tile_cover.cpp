// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/tile_cover.h"

#include <algorithm>
#include <limits>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kSmallEdge = 4;    // tiles are cut no further unless their rays have no shaft
constexpr std::size_t kFew = 3;  // a tile with no more triangles is not cut
constexpr int kStackSize = 128;  // of the hierarchy's traversal: depth is bounded by its builder

/// Keeps what may be met, and how far away the nearest triangle that hides everything behind it is at most.
struct Sieve {
  const RayShaft& shaft;
  const CoverQuery& query;
  double hiddenFrom = std::numeric_limits<double>::infinity();

  [[nodiscard]] std::optional<ShaftHit> test(const HierarchyTriangle& t) {
    if (t.part == query.excludedPart) return std::nullopt;
    const std::optional<ShaftHit> hit = shaft.mayMeet(t.a, t.b, t.c, (t.flags & kCoverSingleSided) != 0);
    if (!hit || hit->nearest > hiddenFrom) return std::nullopt;
    if (hit->coversAll && (t.flags & (kCoverMasked | kCoverBlended)) == 0 && t.part != query.ownPart)
      hiddenFrom = std::min(hiddenFrom, hit->furthest);
    return hit;
  }
};

}  // namespace

void TileCover::compute(const RayImages& rays, const CoverQuery& query, Cover& cover) {
  cover.clear();
  if (hierarchy_.nodes().empty()) return;
  constexpr int kEdge = 1 << (kLevels - 1);
  const int x0 = query.x / kEdge, y0 = query.y / kEdge;
  const int columns = (query.x + query.width - 1) / kEdge - x0 + 1,
            rows = (query.y + query.height - 1) / kEdge - y0 + 1;
  const auto count = std::size_t(columns) * std::size_t(rows);
  if (roots_.size() < count) roots_.resize(count);
  const Job job{rays, query};
  core::parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Root& root = roots_[i];
      root.cover.clear();
      const MirrorTile tile{(x0 + int(i) % columns) * kEdge, (y0 + int(i) / columns) * kEdge, kEdge};
      coverTile(job, tile, 0, nullptr, root);
    }
  });
  for (std::size_t i = 0; i < count; ++i) cover.append(roots_[i].cover);
}

void TileCover::coverTile(const Job& job, const MirrorTile& tile, std::size_t level,
                          const std::vector<Candidate>* from, Root& root) const {
  // 1
  if (!root.rays.gather(job.rays, job.query, tile)) return;
  const std::optional<RayShaft> shaft =
      RayShaft::find({root.rays.origins, root.rays.directions}, job.query.reach);
  if (shaft) {
    // 2, 3
    std::vector<Candidate>& candidates = root.candidates[level];
    findCandidates(job, *shaft, from, candidates);
    if (candidates.empty()) return;
    // 4
    if (tile.edge <= kSmallEdge || candidates.size() <= kFew) {
      emitTile(job, tile, candidates, root);
      return;
    }
    from = &candidates;
  }
  if (tile.edge == 1) return;  // one ray without a direction
  for (int k = 0; k < 4; ++k) coverTile(job, tile.quarter(k), level + 1, from, root);
}

void TileCover::findCandidates(const Job& job, const RayShaft& shaft, const std::vector<Candidate>* from,
                               std::vector<Candidate>& candidates) const {
  const std::span<const HierarchyTriangle> triangles = hierarchy_.triangles();
  candidates.clear();
  Sieve sieve{shaft, job.query};
  const auto keep = [&](std::uint32_t index) {
    if (const auto hit = sieve.test(triangles[index])) candidates.push_back({index, float(hit->nearest)});
  };
  if (from) {
    for (const Candidate& candidate : *from) keep(candidate.index);
  } else {
    const std::span<const TriangleHierarchy::Node> nodes = hierarchy_.nodes();
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t index = stack[--top];
      const TriangleHierarchy::Node& node = nodes[index];
      if (!shaft.mayMeet(node.lower, node.upper)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) keep(i);
      } else {
        stack[top++] = node.first;
        stack[top++] = index + 1;
      }
    }
  }
  // What was kept before something nearer hid it. The float is rounded to nearest, hence the margin.
  const double limit = sieve.hiddenFrom * (1.0 + 1e-6);
  std::erase_if(candidates, [limit](const Candidate& c) { return double(c.nearest) > limit; });
}

void TileCover::emitTile(const Job& job, const MirrorTile& tile, const std::vector<Candidate>& candidates,
                         Root& root) const {
  CoverRect rect = tile.within(job.query);
  root.parts.clear();
  for (const Candidate& candidate : candidates) {
    const HierarchyTriangle& t = hierarchy_.triangles()[candidate.index];
    rect.item = t.triangle;
    if ((t.flags & kCoverBlended) != 0) {
      root.cover.blended.push_back(rect);
      continue;
    }
    ((t.flags & kCoverMasked) != 0 ? root.cover.masked : root.cover.opaque).push_back(rect);
    root.cover.offeredPixels += std::uint64_t(rect.width) * rect.height;
    notePart(t.part, root.parts);
  }
  for (const std::uint32_t part : root.parts) {
    rect.item = part;
    root.cover.parts.push_back(rect);
  }
}

}  // namespace catoptric::virtual_object
