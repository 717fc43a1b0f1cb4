// SPDX-License-Identifier: Apache-2.0
// Which materials are mirrors, which triangles of a mesh make up one mirror, and what shape it has.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catoptric/geometry/shape_recognition.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

/// Is it a mirror, by which lobe, and why (or why not).
struct ReflectorDecision {
  bool isReflector = false;
  float reflectivity = 0;  ///< Surface::reflectivity: the material's own lobe
  float clearcoat = 0;     ///< Surface::clearcoat: mirror by clearcoat only
  std::string reason;      ///< "material: metallic 1, roughness 0"
};

/// Decides for materials as they are used by instances; looks at each texture once.
///
/// In this order: `extras.catoptric` of the node, of the material, then the rule: metallic and roughness
/// within `options` (with a texture: their means, and all but the 2 % most deviating texels as well), or a
/// smooth clearcoat. Unlit materials are never mirrors.
class ReflectorRule {
 public:
  ReflectorRule(const Scene& scene, const ReflectorOptions& options);

  /// `material` as in Part::material.
  [[nodiscard]] const ReflectorDecision& decideByMaterial(int material) const;
  [[nodiscard]] ReflectorDecision decide(int material, const ReflectorHint& instanceHint) const;

 private:
  const Scene& scene_;
  std::vector<ReflectorDecision> byMaterial_;  // the rule alone, one for each material and one for none
};

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
