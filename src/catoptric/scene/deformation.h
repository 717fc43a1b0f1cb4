// SPDX-License-Identifier: Apache-2.0
// The vertices of a mesh primitive at a pose.
//
//   1. Base plus the morph targets times their weights: positions, normals, tangents.
//   2. Skinned: moved by the weighted sum of the joints' matrices, which puts them into the world at once
//      (glTF 2.0 section 3.7.3.3; linear blend skinning); normals by the cofactors of its linear part.
//   3. Normals and tangents to unit length; where nothing is left of one, that of the base stands in.
//      Primitives without normals take those of their triangles.
//
// Cost: linear in vertices times (targets + joints), on all cores.
#pragma once

#include <span>
#include <vector>

#include "catoptric/scene/motion.h"

namespace catoptric::scene {

struct DeformedVertices {
  std::vector<vec3> positions, normals;
  std::vector<vec4> tangents;  ///< empty if the mesh has none
};

/// `weights` of the targets (missing ones count as zero); `worldFromVertex` one for each joint, used where
/// the deformation has influences. `out` is reused: nothing is allocated after the first call.
void deform(const Deformation& deformation, std::span<const float> weights,
            std::span<const dmat4> worldFromVertex, DeformedVertices& out);

}  // namespace catoptric::scene
