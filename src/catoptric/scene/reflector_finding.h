// SPDX-License-Identifier: Apache-2.0
// Which triangles of a mesh make up one mirror, and what shape it has.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catoptric/geometry/shape_recognition.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

/// Triangles (indices into mesh.indices / 3, ascending) of each connected mirror of a mesh: joined where they
/// share a corner with the same normal. Flat pieces in one plane count as one mirror.
struct MirrorPiece {
  std::vector<std::uint32_t> triangles;
};
[[nodiscard]] std::vector<MirrorPiece> findMirrorPieces(const geometry::MeshView& mesh,
                                                        const ReflectorOptions& options);

/// Fills shape, plane, centre, radius, areaWorld, fitError and isConvex of `reflector` from its triangles.
/// `declaredShape` (extras.catoptric) wins over recognition; a plane is never recognised where
/// `hasNormalMap`.
void measureReflector(Reflector& reflector, const geometry::MeshView& mesh,
                      const std::optional<std::string>& declaredShape, bool hasNormalMap,
                      const ReflectorOptions& options);

}  // namespace catoptric::scene
