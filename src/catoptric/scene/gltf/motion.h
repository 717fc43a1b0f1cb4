// SPDX-License-Identifier: Apache-2.0
// Key frames, the tree of nodes and the skins that they drive. Times must be finite, not negative and
// increase; values must be finite; rotations are brought to unit length (zero is refused). Read only if the
// file has animations.
#pragma once

#include <vector>

#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf {

/// Fills Scene::motion.
void importMotion(const Data& data, Scene& scene);

/// One for each joint, affine and finite; identities where the file has none.
[[nodiscard]] std::vector<dmat4> readInverseBindMatrices(const Data& data, const Skin& skin);

}  // namespace catoptric::scene::gltf
