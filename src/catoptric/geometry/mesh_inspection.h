// SPDX-License-Identifier: Apache-2.0
// Questions a test or an importer asks of a mesh. None of them changes it.
#pragma once

#include <cstddef>

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

struct EdgeReport {
  std::size_t interior = 0;      ///< edges with two triangles that run along it in opposite directions
  std::size_t boundary = 0;      ///< edges of one triangle
  std::size_t inconsistent = 0;  ///< edges of two triangles that run the same way: one is turned over
  std::size_t nonManifold = 0;   ///< edges of three and more
  [[nodiscard]] bool isWatertight() const { return boundary + inconsistent + nonManifold == 0; }
};

/// Counts edges; vertices closer than the tolerance are one.
[[nodiscard]] EdgeReport inspectEdges(const Mesh& mesh, double positionTolerance = 1e-6);

/// Volume enclosed by a watertight mesh; negative if it is inside out.
[[nodiscard]] double computeSignedVolume(const Mesh& mesh);

/// Largest angle between a triangle's plane normal and the normals at its corners, radians.
[[nodiscard]] double findLargestNormalDeviation(const Mesh& mesh);

/// Largest angle, radians, by which two neighbouring triangles bend towards their front, 0 for a convex
/// surface. Bends below what float positions can express are left out.
[[nodiscard]] double findDeepestConcavity(const Mesh& mesh, double positionTolerance = 1e-6);

/// Smallest angle of any triangle, radians.
[[nodiscard]] double findSmallestCorner(const Mesh& mesh);

[[nodiscard]] core::Box computeBounds(const Mesh& mesh);

}  // namespace catoptric::geometry
