// SPDX-License-Identifier: Apache-2.0
// Which materials are mirrors.
#pragma once

#include <string>
#include <vector>

#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

/// Is it a mirror, by which lobe, and why (or why not).
struct ReflectorDecision {
  bool isReflector = false;
  float reflectivity = 0;    ///< Surface::reflectivity: the material's own lobe
  float clearcoat = 0;       ///< Surface::clearcoat: mirror by clearcoat only
  bool isRefractor = false;  ///< light goes through instead
  std::string reason;        ///< "material: metallic 1, roughness 0"
};

/// Decides for materials as they are used by instances; looks at each texture once.
///
/// In this order: `extras.catoptric` of the node, of the material, then the rule: metallic and roughness
/// within `options` (with a texture: their means, and all but the 2 % most deviating texels as well), or a
/// smooth clearcoat. A smooth material of a solid that lets at least half of the light through
/// (KHR_materials_transmission and _volume) is a refractor. Unlit materials are never mirrors.
class ReflectorRule {
 public:
  ReflectorRule(const Scene& scene, const ReflectorOptions& options);
  /// For one material only: its texture alone is looked at.
  ReflectorRule(const Scene& scene, const ReflectorOptions& options, int onlyMaterial);

  /// `material` as in Part::material.
  [[nodiscard]] const ReflectorDecision& decideByMaterial(int material) const;
  [[nodiscard]] ReflectorDecision decide(int material, const ReflectorHint& instanceHint) const;

 private:
  const Scene& scene_;
  std::vector<ReflectorDecision> byMaterial_;  // the rule alone, one for each material and one for none
};

}  // namespace catoptric::scene
