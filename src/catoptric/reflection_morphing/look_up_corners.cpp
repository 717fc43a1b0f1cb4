// SPDX-License-Identifier: Apache-2.0
// Where are the vertices of a scene seen from the eight locations of a cell?
//
// In: one trace at eight locations, vertices (world, metres), triangles. Out: for each vertex and location
// the mirror point and the path from there to the vertex (2004, section 6, MORPH_VERTEX).
//   1. Vertices that lie in the shaft of the first or the last location (ray_shaft.cpp) are taken in batches.
//   2. corner_look_up.cpp looks them up. What neither of the two locations sees is not reflected.
//   3. Vertices that share a triangle with a reflected one close it at the rim: they are looked up at every
//      location, and again their neighbours if some location sees one of them.
//
// Departures from 2004: the paper looks every vertex up at every location, and drops what step 3 finds. The
// result does not depend on the number of threads: blocks are cut at fixed places, the rim is sorted.
// Cost: that of corner_look_up.cpp for what is inside a shaft.
// Source: Martin & Popescu 2004, section 6.
#include <algorithm>
#include <atomic>
#include <mutex>

#include "catoptric/core/parallel.h"
#include "catoptric/reflection_morphing/corner_look_up.h"
#include "catoptric/reflection_morphing/morphing.h"

namespace catoptric::reflection_morphing {
namespace {

using raster::VertexKind;

constexpr std::size_t kBlock = 2048;  // vertices that a thread takes together

/// Looks up `count` vertices, `vertexAt(i)` each; in blocks that do not depend on the threads.
template <class VertexAt>
void lookUpAll(const CellTrace& trace, std::span<const vec3> points, std::size_t count, bool all,
               const VertexAt& vertexAt, CornerPoints& corners) {
  core::parallelFor((count + kBlock - 1) / kBlock, 1, [&](std::size_t begin, std::size_t end) {
    CornerLookUp lookUp(trace, points, all, corners);
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t last = std::min(count, (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < last; ++i) lookUp.add(vertexAt(i));
      lookUp.run();
    }
  });
}

/// Triangles that lie side by side, and the vertices that they have.
struct TriangleBlock {
  std::uint32_t firstVertex = 0, lastVertex = 0;
  /// Has it a vertex of the sorted list?
  [[nodiscard]] bool mayHaveOneOf(std::span<const std::uint32_t> vertices) const {
    const auto at = std::lower_bound(vertices.begin(), vertices.end(), firstVertex);
    return at != vertices.end() && *at <= lastVertex;
  }
};

/// Step 3.
class RimFinder {
 public:
  RimFinder(std::span<const std::uint32_t> indices, CornerPoints& corners)
      : indices_(indices), corners_(corners), blocks_((indices.size() + kBlockIndices - 1) / kBlockIndices) {}

  /// Marks vertices that have not been looked up and share a triangle with a reflected one, and lists them in
  /// corners.rim.
  void run() {
    reflected_.clear();
    for (const std::uint32_t vertex : corners_.rim)
      if (corners_.kinds[vertex] == VertexKind::Reflected) reflected_.push_back(vertex);
    corners_.rim.clear();
    core::parallelFor(blocks_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> marked;
      for (std::size_t block = begin; block < end; ++block)
        if (isFirst_ || blocks_[block].mayHaveOneOf(reflected_)) markIn(block, marked);
      const std::scoped_lock lock(mutex_);
      corners_.rim.insert(corners_.rim.end(), marked.begin(), marked.end());
    });
    isFirst_ = false;
    std::sort(corners_.rim.begin(), corners_.rim.end());  // whoever found them
  }

 private:
  static constexpr std::size_t kBlockIndices = 3 * 256, kGrain = 16;

  [[nodiscard]] VertexKind kindOf(std::uint32_t vertex) const {
    return std::atomic_ref(corners_.kinds[vertex]).load(std::memory_order_relaxed);
  }
  void markIn(std::size_t block, std::vector<std::uint32_t>& marked) {
    const auto some = indices_.subspan(block * kBlockIndices);
    const auto indices = some.first(std::min(some.size(), kBlockIndices));
    if (isFirst_) {
      TriangleBlock bounds{indices[0], indices[0]};
      for (const std::uint32_t v : indices)
        bounds = {std::min(bounds.firstVertex, v), std::max(bounds.lastVertex, v)};
      blocks_[block] = bounds;
    }
    for (std::size_t t = 0; t < indices.size(); t += 3) {
      unsigned reflected = 0;
      for (std::size_t k = 0; k < 3; ++k)
        reflected += unsigned(kindOf(indices[t + k]) == VertexKind::Reflected);
      if (reflected == 0 || reflected == 3) continue;
      for (const std::uint32_t v : indices.subspan(t, 3))
        if (kindOf(v) == VertexKind::None &&
            std::atomic_ref(corners_.kinds[v]).exchange(VertexKind::DoublyVirtual) == VertexKind::None)
          marked.push_back(v);
    }
  }

  std::span<const std::uint32_t> indices_;
  CornerPoints& corners_;
  std::vector<TriangleBlock> blocks_;
  std::vector<std::uint32_t> reflected_;  ///< of those that have been looked up last
  bool isFirst_ = true;
  std::mutex mutex_;
};

}  // namespace

void lookUpCorners(const CellTrace& trace, std::span<const vec3> scenePoints,
                   std::span<const std::uint32_t> indices, CornerPoints& corners) {
  const std::size_t count = scenePoints.size();
  corners.points.resize(count);
  corners.kinds.assign(count, VertexKind::None);
  if (std::all_of(trace.begin(), trace.end(), [](const auto* t) { return t == nullptr; })) return;
  for (std::size_t k = 0; k < 8; ++k)
    if (trace[k] == nullptr)
      for (auto& points : corners.points) points[k] = vec4(0);
  corners.rim.clear();
  lookUpAll(
      trace, scenePoints, count, false, [](std::size_t i) { return std::uint32_t(i); }, corners);
  RimFinder rim(indices, corners);
  for (bool goesOn = !indices.empty(); goesOn;) {
    rim.run();
    lookUpAll(
        trace, scenePoints, corners.rim.size(), true, [&](std::size_t i) { return corners.rim[i]; }, corners);
    goesOn = std::any_of(corners.rim.begin(), corners.rim.end(),
                         [&](std::uint32_t v) { return corners.kinds[v] == VertexKind::Reflected; });
  }
}

}  // namespace catoptric::reflection_morphing
