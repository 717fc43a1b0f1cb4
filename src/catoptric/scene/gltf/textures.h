// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf {

/// Fills Scene::materials (those of the file, then glTF's default material) and Scene::textures: one for each
/// pair of image and sampler that a material uses; images that no material uses are not read.
void importMaterials(const Data& data, Scene& scene);

}  // namespace catoptric::scene::gltf
