// SPDX-License-Identifier: Apache-2.0
// The eight look-ups of vertices; the memory of a thread for look_up_corners.cpp.
#pragma once

#include "catoptric/reflection_morphing/corner_batch.h"

namespace catoptric::reflection_morphing {

class CornerLookUp {
 public:
  /// All must outlive the object. Some location must have the trace. Vertices that neither of two opposite
  /// locations sees are left alone, unless `all`.
  CornerLookUp(const CellTrace& trace, std::span<const vec3> points, bool all, CornerPoints& corners);

  void add(std::uint32_t vertex);
  /// Looks up what has been added.
  void run();

 private:
  /// Vertices that a location is asked for.
  struct Question {
    std::size_t location = 0, count = 0;
    std::array<std::uint32_t, kMostSearches> vertices{};
    RayBatch batch;

    bool add(std::uint32_t vertex, const vec3& point);
  };
  void askFirst();
  void askLast();

  const CellTrace& trace_;
  std::span<const vec3> points_;
  bool all_;
  Question first_, last_;
  CornerBatch seenFromFirst_, seenFromLast_;
};

}  // namespace catoptric::reflection_morphing
