// SPDX-License-Identifier: Apache-2.0
// Where is a vertex seen from the eight locations of a cell?
//
// In: one trace at eight locations, vertices (world, metres). Out: for each vertex and location the mirror
// point and the path from there to the vertex (2004, section 6, MORPH_VERTEX).
//   1. Vertices are taken in batches. At the first location that has the trace, the leaf of the octree that
//      holds the vertex gives rays that pass near; from the nearest of them the map is searched for the ray
//      that passes through the vertex (find_ray.cpp).
//   2. A vertex that is seen neither from there nor from the last location is not reflected; see 6.
//   3. At the neighbours of the first location the ray has nearly the same place in the map. How far it is
//      off changes little from vertex to vertex: the search starts from the first location's ray, moved by as
//      much as the vertices before were moved.
//   4. At the other four the place is extrapolated from those that are known; it mostly is right at once.
//   5. Where a search of 3 or 4 ends outside of the trace, the octree of the location itself is asked.
//   6. Vertices that share a triangle with a reflected one close it at the rim: they are looked up at every
//      location, and again their neighbours if some location sees one of them.
//
// Departures from 2004: eight octree look-ups a vertex are one and seven short ones. It takes a third of the
// time, and where several rays of a trace pass through a vertex (behind a focus) the locations agree on one.
// The result does not depend on the number of threads: batches are cut at fixed places. Cost: 0.5 us a
// vertex and core. Source: Martin & Popescu 2004, section 6.
#include <algorithm>
#include <atomic>

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

/// Step 6: marks vertices that have not been looked up and share a triangle with a reflected one.
void markRim(std::span<const std::uint32_t> indices, CornerPoints& corners) {
  core::parallelFor(indices.size() / 3, 4096, [&](std::size_t begin, std::size_t end) {
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
        if (kinds[k] == VertexKind::None)
          std::atomic_ref(corners.kinds[v[k]]).store(VertexKind::DoublyVirtual, std::memory_order_relaxed);
    }
  });
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
  corners.isLookedUp.assign(count, 0);
  for (bool goesOn = !indices.empty(); goesOn;) {
    for (std::size_t i = 0; i < count; ++i) corners.isLookedUp[i] = corners.kinds[i] != VertexKind::None;
    markRim(indices, corners);
    corners.rim.clear();
    for (std::uint32_t i = 0; i < count; ++i)
      if (corners.kinds[i] != VertexKind::None && corners.isLookedUp[i] == 0) corners.rim.push_back(i);
    lookUpAll(
        trace, scenePoints, corners.rim.size(), true, [&](std::size_t i) { return corners.rim[i]; }, corners);
    goesOn = std::any_of(corners.rim.begin(), corners.rim.end(),
                         [&](std::uint32_t v) { return corners.kinds[v] == VertexKind::Reflected; });
  }
}

}  // namespace catoptric::reflection_morphing
