// SPDX-License-Identifier: Apache-2.0
// Where are the vertices of a scene seen from the eight locations of a cell?
//
// In: one trace at eight locations, vertices (world, metres), triangles. Out: for each vertex and location
// the mirror point and the path from there to the vertex (2004, section 6, MORPH_VERTEX).
//   1. Vertices that lie in the shaft of the first or the last location (ray_shaft.cpp) are taken in batches.
//   2. corner_look_up.cpp looks a batch up. What neither of the two locations sees is not reflected.
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
    CornerLookUp lookUp(trace, points, corners);
    for (std::size_t block = begin; block < end; ++block) {
      for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
        if (all || lookUp.mayBeSeen(vertexAt(i))) lookUp.add(vertexAt(i));
        if (lookUp.isFull()) lookUp.run(all);
      }
      lookUp.run(all);
    }
  });
}

/// Step 3: marks vertices that have not been looked up and share a triangle with a reflected one, and lists
/// them in corners.rim.
void markRim(std::span<const std::uint32_t> indices, CornerPoints& corners) {
  corners.rim.clear();
  std::mutex mutex;
  core::parallelFor(indices.size() / 3, 8192, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> marked;
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* v = &indices[3 * t];
      VertexKind kinds[3];
      unsigned reflected = 0;
      for (int k = 0; k < 3; ++k) {
        kinds[k] = std::atomic_ref(corners.kinds[v[k]]).load(std::memory_order_relaxed);
        reflected += kinds[k] == VertexKind::Reflected ? 1u : 0u;
      }
      if (reflected % 3 == 0) continue;
      for (int k = 0; k < 3; ++k)
        if (kinds[k] == VertexKind::None &&
            std::atomic_ref(corners.kinds[v[k]]).exchange(VertexKind::DoublyVirtual) == VertexKind::None)
          marked.push_back(v[k]);
    }
    const std::scoped_lock lock(mutex);
    corners.rim.insert(corners.rim.end(), marked.begin(), marked.end());
  });
  std::sort(corners.rim.begin(), corners.rim.end());  // whoever found them
}

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
  lookUpAll(
      trace, scenePoints, count, false, [](std::size_t i) { return std::uint32_t(i); }, corners);
  for (bool goesOn = !indices.empty(); goesOn;) {
    markRim(indices, corners);
    lookUpAll(
        trace, scenePoints, corners.rim.size(), true, [&](std::size_t i) { return corners.rim[i]; }, corners);
    goesOn = std::any_of(corners.rim.begin(), corners.rim.end(),
                         [&](std::uint32_t v) { return corners.kinds[v] == VertexKind::Reflected; });
  }
}

}  // namespace catoptric::reflection_morphing
