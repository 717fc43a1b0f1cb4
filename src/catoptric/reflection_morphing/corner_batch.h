// SPDX-License-Identifier: Apache-2.0
// The look-ups of a batch of vertices at the other locations of a cell, where one location is known.
#pragma once

#include "catoptric/reflection_morphing/find_ray.h"
#include "catoptric/reflection_morphing/morphing.h"

namespace catoptric::reflection_morphing {

class CornerBatch {
 public:
  /// All must outlive the object. `base`: the location that is known; it has the trace.
  CornerBatch(const CellTrace& trace, std::size_t base, CornerPoints& corners)
      : trace_(trace), corners_(corners), base_(base) {}

  /// Vertex of search i of `found`, which has been made at the base location. Looks the batch up when it is
  /// full.
  void take(std::uint32_t vertex, const RayBatch& found, std::size_t i, bool isInside);
  /// Looks up what has been taken, and starts anew.
  void run();

 private:
  using Floats = RayBatch::Floats;
  /// Places in a table, relative to where they are expected, as an affine function of the place at the base.
  struct Drift {
    vec2 middle{0}, mean{0}, perX{0}, perY{0};
  };
  SearchSet expect(std::size_t location);
  [[nodiscard]] Drift measureDrift(std::size_t location, SearchSet expected);
  void start(std::size_t location, SearchSet expected, const Drift& drift);
  void lookUpAt(std::size_t location);
  void searchFromOthers(std::size_t location);
  void keep(std::size_t location, SearchSet which);
  /// Is there a sense in interpolating what the locations see?
  [[nodiscard]] SearchSet findAgreeing() const;

  const CellTrace& trace_;
  CornerPoints& corners_;
  std::size_t base_, count_ = 0;
  SearchSet all_ = 0;
  std::array<std::uint32_t, kMostSearches> vertices_{};
  RayBatch batch_, samples_;
  std::array<Floats, 8> chartX_{}, chartY_{};  ///< where the rays are, in each location's chart
  std::array<SearchSet, 8> seen_{};            ///< by each location
  std::array<SearchSet, 8> doubtful_{};        ///< not found, but not for sure
  Floats expectedX_{}, expectedY_{};           ///< texels
};

}  // namespace catoptric::reflection_morphing
