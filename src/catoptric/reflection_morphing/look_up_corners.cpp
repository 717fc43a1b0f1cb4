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
#include <array>
#include <atomic>
#include <bit>
#include <bitset>

#include "catoptric/core/parallel.h"
#include "catoptric/reflection_morphing/find_ray.h"
#include "catoptric/reflection_morphing/morphing.h"

namespace catoptric::reflection_morphing {
namespace {

using raster::VertexKind;

constexpr std::size_t kBatch = 64;    // vertices; the texels of that many searches fit the nearest cache
constexpr std::size_t kBlock = 2048;  // vertices that a thread takes together
constexpr std::size_t kGroup = 16;    // of them that are searched from the same move

using Batch = std::array<FoundRay, kBatch>;

/// The ray of the leaf that is nearest to the middle of the map.
std::uint32_t findInnermostRay(const RayMap& map, std::span<const std::uint32_t> leaf) {
  const auto size = std::uint32_t(map.size);
  const auto distance = [&](std::uint32_t ray) {
    const int x = 2 * int(ray % size) - map.size, y = 2 * int(ray / size) - map.size;
    return x * x + y * y;
  };
  return *std::min_element(leaf.begin(), leaf.end(),
                           [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

/// Searches at one location, led side by side; the memory of a thread.
class Searches {
 public:
  void setLocation(const SampledTrace& trace, std::span<const vec3> points) {
    trace_ = &trace;
    points_ = points;
    asked_.reset();
  }
  /// Vertex i, from the octree.
  void addByOctree(std::size_t i) {
    byOctree_[byOctreeCount_++] = std::uint8_t(i);
    asked_.set(i);
  }
  [[nodiscard]] bool hasAskedOctree(std::size_t i) const { return asked_[i]; }
  /// ... from a place of the map; from the octree where the map has nothing there.
  void add(std::size_t i, const vec2& texel) {
    if (trace_->map.isFilled(texel))
      queries_[count_++] = {points_[i], texel, std::uint32_t(i)};
    else
      addByOctree(i);
  }
  void run(Batch& found) {
    if (byOctreeCount_ > 0) addOctreeQueries();
    runQueries(found);
    if (byOctreeCount_ > 0) tryInnerRays(found);
    byOctreeCount_ = 0;
  }

 private:
  void runQueries(Batch& found) {
    findRays(trace_->map, std::span(queries_).first(count_), found);
    count_ = 0;
  }
  void addQuery(std::size_t i, std::uint32_t ray) {
    const auto size = std::uint32_t(trace_->map.size);
    queries_[count_++] = {points_[i], vec2(ray % size, ray / size), std::uint32_t(i)};
  }
  void addOctreeQueries() {
    const RayMap& map = trace_->map;
    for (std::size_t k = 0; k < byOctreeCount_; ++k) {
      leaves_[k] = trace_->octree.findLeaf(points_[byOctree_[k]]);
      __builtin_prefetch(leaves_[k].data());
    }
    for (std::size_t k = 0; k < byOctreeCount_; ++k)
      for (const std::uint32_t ray : leaves_[k]) __builtin_prefetch(&map.texels[ray]);
    for (std::size_t k = 0; k < byOctreeCount_; ++k)
      addQuery(byOctree_[k], findNearestRay(map, leaves_[k], points_[byOctree_[k]]));
  }
  /// A ray at the very rim may be the nearest and yet lead nowhere: directions turn fast there.
  void tryInnerRays(Batch& found) {
    for (std::size_t k = 0; k < byOctreeCount_; ++k) {
      const std::size_t i = byOctree_[k];
      other_[i].isInside = false;
      if (!found[i].isInside && leaves_[k].size() > 1) addQuery(i, findInnermostRay(trace_->map, leaves_[k]));
    }
    runQueries(other_);
    for (std::size_t k = 0; k < byOctreeCount_; ++k)
      if (other_[byOctree_[k]].isInside) found[byOctree_[k]] = other_[byOctree_[k]];
  }

  const SampledTrace* trace_ = nullptr;
  std::span<const vec3> points_;
  std::array<RayQuery, kBatch> queries_;
  std::array<std::span<const std::uint32_t>, kBatch> leaves_;
  std::array<std::uint8_t, kBatch> byOctree_;
  std::bitset<kBatch> asked_;
  std::size_t count_ = 0, byOctreeCount_ = 0;
  Batch other_;
};

/// The eight look-ups of a batch of vertices; the memory of a thread.
class CornerLookUp {
 public:
  CornerLookUp(const CellTrace& trace, std::span<const vec3> points, CornerPoints& corners)
      : trace_(trace), allPoints_(points), corners_(corners) {
    for (std::size_t k = 0; k < 8; ++k)
      if (trace[k] != nullptr) present_ |= 1u << k;
    first_ = std::size_t(std::countr_zero(present_));
    last_ = std::size_t(std::bit_width(present_)) - 1;
  }

  void add(std::uint32_t vertex) {
    vertices_[count_] = vertex;
    points_[count_++] = allPoints_[vertex];
  }
  /// Can the vertex be seen from one of two opposite locations?
  [[nodiscard]] bool mayBeSeen(std::uint32_t vertex) const {
    const vec3& point = allPoints_[vertex];
    return trace_[first_]->shaft.mayReach(point) || trace_[last_]->shaft.mayReach(point);
  }
  [[nodiscard]] bool isFull() const { return count_ == kBatch; }
  /// Looks up what has been added. Vertices that neither of two opposite locations sees are left alone,
  /// unless `all`.
  void run(bool all) {
    if (count_ == 0) return;
    setLocation(first_);
    for (std::size_t i = 0; i < count_; ++i) searches_.addByOctree(i);
    searches_.run(found_);
    if (!all) keepSeen();
    keep(first_);
    for (std::size_t k = first_ + 1; k < 8; ++k) {
      if (trace_[k] == nullptr) continue;
      setLocation(k);
      if (std::popcount(k) > 1 && present_ == 0xffu)
        lookUpFromNeighbours(k);
      else
        lookUpFromFirst(k);
      keep(k);
    }
    for (std::size_t i = 0; i < count_; ++i)
      corners_.kinds[vertices_[i]] = isInside_[i] != 0 ? VertexKind::Reflected : VertexKind::DoublyVirtual;
    count_ = 0;
  }

 private:
  void setLocation(std::size_t location) {
    searches_.setLocation(*trace_[location], std::span(points_).first(count_));
  }
  /// Step 2: drops the vertices that are seen neither from the first nor from the last location.
  void keepSeen() {
    if (last_ != first_) {
      setLocation(last_);
      for (std::size_t i = 0; i < count_; ++i) {
        fromLast_[i].isInside = false;
        if (!found_[i].isInside) searches_.addByOctree(i);
      }
      searches_.run(fromLast_);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!found_[i].isInside && !(last_ != first_ && fromLast_[i].isInside)) continue;
      vertices_[kept] = vertices_[i];
      points_[kept] = points_[i];
      found_[kept++] = found_[i];
    }
    count_ = kept;
  }
  void keep(std::size_t location) {
    const RayMap& map = trace_[location]->map;
    for (std::size_t i = 0; i < count_; ++i) {
      const FoundRay& ray = found_[i];
      corners_.points[vertices_[i]][location] = vec4(ray.mirrorPoint, ray.rest);
      chart_[location][i] = map.lower + ray.texel * map.step;
      const unsigned others = location == first_ ? 0u : isInside_[i];
      isInside_[i] = std::uint8_t(others | unsigned(ray.isInside) << location);
    }
  }
  /// Step 3.
  void lookUpFromFirst(std::size_t k) {
    vec2 move(0);
    bool knowsMove = false;
    for (std::size_t group = 0; group < count_; group += kGroup) {
      const std::size_t end = std::min(group + kGroup, count_);
      for (std::size_t i = group; i < end; ++i)
        if (knowsMove && isInside(first_, i))
          searches_.add(i, toTexel(k, chart_[first_][i]) + move);
        else
          searches_.addByOctree(i);
      searches_.run(found_);
      searchAgain(group, end);
      for (std::size_t i = end; i-- > group;)
        if (isInside(first_, i) && found_[i].isInside) {
          move = found_[i].texel - toTexel(k, chart_[first_][i]);
          knowsMove = true;
          break;
        }
    }
  }
  /// Step 4; k is none of the neighbours of location 0.
  void lookUpFromNeighbours(std::size_t k) {
    const std::size_t a = (k & 1) != 0 ? 1 : 2, b = (k & 4) != 0 ? 4 : 2;
    const unsigned needed = 1u | 1u << a | 1u << b;
    for (std::size_t i = 0; i < count_; ++i) {
      if ((isInside_[i] & needed) != needed) {
        searches_.addByOctree(i);
        continue;
      }
      vec2 chart = chart_[a][i] + chart_[b][i] - chart_[0][i];
      if (k == 7) chart = chart_[3][i] + chart_[5][i] + chart_[6][i] - chart_[2][i] - chart;
      searches_.add(i, toTexel(k, chart));
    }
    searches_.run(found_);
    searchAgain(0, count_);
  }
  /// Step 5.
  void searchAgain(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!found_[i].isInside && !searches_.hasAskedOctree(i)) searches_.addByOctree(i);
    searches_.run(found_);
  }

  [[nodiscard]] bool isInside(std::size_t location, std::size_t i) const {
    return (isInside_[i] >> location & 1u) != 0;
  }
  [[nodiscard]] vec2 toTexel(std::size_t location, const vec2& chart) const {
    const RayMap& map = trace_[location]->map;
    return (chart - map.lower) / map.step;
  }

  const CellTrace& trace_;
  std::span<const vec3> allPoints_;
  CornerPoints& corners_;
  unsigned present_ = 0;  ///< a bit for each location that has the trace
  std::size_t first_ = 0, last_ = 0;
  std::size_t count_ = 0;
  std::array<std::uint32_t, kBatch> vertices_;
  std::array<vec3, kBatch> points_;
  Searches searches_;
  Batch found_, fromLast_;
  std::array<std::array<vec2, kBatch>, 8> chart_;  ///< where the rays are, in each location's chart
  std::array<std::uint8_t, kBatch> isInside_{};    ///< a bit for each location
};

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
      for (int k = 0; k < 3; ++k)
        kinds[k] = std::atomic_ref(corners.kinds[v[k]]).load(std::memory_order_relaxed);
      if (std::count(kinds, kinds + 3, VertexKind::Reflected) % 3 == 0) continue;
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
