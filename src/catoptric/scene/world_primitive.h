// SPDX-License-Identifier: Apache-2.0
// One primitive of one instance carried to world space: the first step of makeWorldGeometry().
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "catoptric/scene/reflector_finding.h"
#include "catoptric/scene/reflector_rule.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene {

/// One primitive of one instance in world space.
struct WorldPrimitive {
  std::uint32_t instance = 0;
  std::uint32_t number = 0;  // of the mesh's primitives
  int material = -1;
  const MeshPrimitive* source = nullptr;
  double handedness = 1;  // -1 where the transform mirrors
  std::vector<vec3> positions, normals;
  std::vector<std::uint32_t> indices;  // kept triangles
  ReflectorDecision decision;
  std::vector<MirrorPiece> pieces;  // empty: no mirror
  std::size_t firstReflector = 0;   // its pieces' names
};

/// Fills handedness, positions, normals and indices from `source`: positions in double, stored as float;
/// normals by the inverse transpose, recomputed where they are no direction; winding flipped where the
/// transform mirrors. Triangles of zero area or with an unusable vertex are dropped; returns how many.
[[nodiscard]] std::uint64_t transformPrimitive(WorldPrimitive& primitive, const dmat4& worldFromMesh);

}  // namespace catoptric::scene
