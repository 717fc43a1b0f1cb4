// SPDX-License-Identifier: Apache-2.0
// By how much a simplified mesh misses the mesh that it was made from: step 4 of simplified_levels.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/geometry/simplified_levels.h"
#include "catoptric/geometry/triangle_hierarchy.h"

namespace catoptric::geometry {

struct NearestPoint;

class LevelJudge {
 public:
  /// `joined`: the mesh's corners, equal vertices being one. Both must outlive the object.
  LevelJudge(const SimplifiableMesh& mesh, const std::vector<std::uint32_t>& joined);

  /// Sets the level's errors; infinite where a connected piece of the mesh is not there any more.
  void measure(SimplifiedLevel& level) const;

 private:
  [[nodiscard]] TriangleHierarchy makeHierarchy(std::span<const std::uint32_t> indices) const;
  void compareVertex(std::uint32_t vertex, const NearestPoint& nearest,
                     std::span<const std::uint32_t> indices, SimplifiedLevel& level) const;
  void measureFromMesh(SimplifiedLevel& level) const;
  void measureFromLevel(SimplifiedLevel& level) const;

  const SimplifiableMesh& mesh_;
  std::vector<std::uint32_t> used_;     ///< vertices
  std::vector<std::uint32_t> pieceOf_;  ///< by vertex: the connected piece, named by one of its vertices
  std::vector<float> uv0PerUnit_, uv1PerUnit_;  ///< by vertex: least texture coordinates per unit of length
  TriangleHierarchy hierarchy_;                 ///< of the mesh
};

}  // namespace catoptric::geometry
