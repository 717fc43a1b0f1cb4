// SPDX-License-Identifier: Apache-2.0
// Coarser triangles for what mirrors show small: for each part of the world lists of triangles over the
// part's own vertices, with their measured error (geometry/simplified_levels.h). The primary image, mirrors
// themselves and the ray-traced truth never use them.
//
// Left at full detail are parts that an animation deforms, solids of glass, and mirrors other than convex
// ones: a ray that goes on from a coarser surface must not meet the finer one. Instances of one mesh share
// the work. Triangles of levels are numbered on from the world's, so that a picture of numbers can hold both.
// Cost: once a scene, on all cores, see simplified_levels.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

struct DetailLevel {
  std::uint32_t firstTriangle = 0;  ///< number; the world's own triangles come before all levels'
  std::uint32_t triangleCount = 0;
  double distanceMesh = 0;       ///< of its surface or texture from the part's, units of its mesh
  double normalRadiansMesh = 0;  ///< largest angle between its normals and the part's, in its mesh
};

class LevelsOfDetail {
 public:
  /// `world` was made from `scene`.
  LevelsOfDetail(const scene::Scene& scene, const scene::WorldGeometry& world);

  /// After parts have moved, been scaled or turned their winding.
  void update(const scene::Scene& scene, const scene::WorldGeometry& world,
              std::span<const std::uint32_t> movedParts);

  /// Of a part, from fine to coarse, without the part itself.
  [[nodiscard]] std::span<const DetailLevel> levels(std::uint32_t part) const {
    return std::span(levels_).subspan(runs_[part].first, runs_[part].count);
  }
  /// World vertices, three for each triangle.
  [[nodiscard]] std::span<const std::uint32_t> corners(const DetailLevel& level) const {
    return std::span(indices_).subspan(3 * std::size_t(level.firstTriangle - worldTriangles_),
                                       3 * std::size_t(level.triangleCount));
  }
  /// In world units: how far a level of the part is from it.
  [[nodiscard]] double findDistance(std::uint32_t part, const DetailLevel& level) const {
    return runs_[part].largestScale * level.distanceMesh;
  }
  /// How much normals differ, radians; an upper bound where the part is scaled unevenly.
  [[nodiscard]] double findTurn(std::uint32_t part, const DetailLevel& level) const {
    return runs_[part].largestScale / runs_[part].leastScale * level.normalRadiansMesh;
  }

  /// Of all levels; corners as in WorldGeometry::indices.
  [[nodiscard]] std::span<const std::uint32_t> indices() const { return indices_; }
  /// By number, of the world's triangles and then the levels'.
  [[nodiscard]] std::span<const std::uint32_t> triangleParts() const { return triangleParts_; }

 private:
  struct Run {
    std::uint32_t first = 0, count = 0;       ///< of levels_
    std::uint32_t secondCorner = 0;           ///< of the part's first triangle: tells how it is wound
    double largestScale = 1, leastScale = 1;  ///< from mesh to world
  };
  void measureScale(const scene::Scene& scene, const scene::Part& part, Run& run);

  std::uint32_t worldTriangles_ = 0;
  std::vector<Run> runs_;  ///< by part
  std::vector<DetailLevel> levels_;
  std::vector<std::uint32_t> indices_, triangleParts_;
};

/// May a coarser list of triangles stand for the part, as it is now?
[[nodiscard]] bool maySimplify(const scene::Scene& scene, const scene::WorldGeometry& world,
                               std::uint32_t part);

}  // namespace catoptric::raster
