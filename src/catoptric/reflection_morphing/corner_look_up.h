// SPDX-License-Identifier: Apache-2.0
// The eight look-ups of a batch of vertices; the memory of a thread for look_up_corners.cpp.
#pragma once

#include <bitset>

#include "catoptric/reflection_morphing/find_ray.h"
#include "catoptric/reflection_morphing/morphing.h"

namespace catoptric::reflection_morphing {

/// Searches at one location that begin at rays of the octree.
class OctreeSearches {
 public:
  /// Vertex i of the batch.
  void add(std::size_t i) { which_[count_++] = std::uint8_t(i); }
  /// Searches for what has been added since the last run().
  void run(const SampledTrace& trace, RayBatch& batch);

 private:
  void begin(const SampledTrace& trace, RayBatch& batch);
  void tryInnerRays(const SampledTrace& trace, RayBatch& batch);

  std::array<std::uint8_t, kMostSearches> which_;
  std::array<std::span<const std::uint32_t>, kMostSearches> leaves_;
  std::size_t count_ = 0;
  RayBatch other_;
};

class CornerLookUp {
 public:
  /// All must outlive the object. Some location must have the trace.
  CornerLookUp(const CellTrace& trace, std::span<const vec3> points, CornerPoints& corners);

  /// Can the vertex be seen from one of two opposite locations?
  [[nodiscard]] bool mayBeSeen(std::uint32_t vertex) const {
    return trace_[first_]->shaft.mayReach(points_[vertex]) || trace_[last_]->shaft.mayReach(points_[vertex]);
  }
  /// Not if isFull().
  void add(std::uint32_t vertex);
  [[nodiscard]] bool isFull() const { return count_ == kMostSearches; }
  /// Looks up what has been added. Vertices that neither of two opposite locations sees are left alone,
  /// unless `all`.
  void run(bool all);

 private:
  using Floats = RayBatch::Floats;
  /// Places in a table, relative to where they are expected, as an affine function of the place at the first
  /// location.
  struct Drift {
    vec2 middle{0}, mean{0}, perX{0}, perY{0};
  };
  void keepSeen();
  void expect(std::size_t location);
  [[nodiscard]] Drift fitDrift() const;
  void lookUpAt(std::size_t location);
  void searchFromOthers(std::size_t location);
  void keep(std::size_t location);
  void keepOne(std::size_t location, std::size_t i);
  /// Is there a sense in interpolating what the locations see?
  [[nodiscard]] bool agree(std::size_t i) const;

  [[nodiscard]] bool isInside(std::size_t location, std::size_t i) const {
    return (isInside_[i] >> location & 1u) != 0;
  }

  const CellTrace& trace_;
  std::span<const vec3> points_;
  CornerPoints& corners_;
  unsigned present_ = 0;  ///< a bit for each location that has the trace
  std::size_t first_ = 0, last_ = 0;
  std::size_t count_ = 0;
  std::array<std::uint32_t, kMostSearches> vertices_;
  OctreeSearches searches_;
  RayBatch batch_, other_;
  std::array<Floats, 8> chartX_, chartY_;               ///< where the rays are, in each location's chart
  Floats expectedX_, expectedY_;                        ///< texels
  std::uint8_t needed_ = 0;                             ///< a bit for each location that they are made from
  std::array<std::uint8_t, kMostSearches> isInside_{};  ///< a bit for each location
  std::array<std::uint8_t, kMostSearches> which_;
};

}  // namespace catoptric::reflection_morphing
