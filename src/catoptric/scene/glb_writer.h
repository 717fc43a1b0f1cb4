// SPDX-License-Identifier: Apache-2.0
// Scene to binary glTF 2.0: the inverse of the importer, for the built-in scenes and for tests.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "catoptric/scene/scene.h"

namespace catoptric::scene {

struct GlbOptions {
  /// Opaque textures of at least this many pixels are stored as JPEG, others as PNG; 0 = PNG always.
  std::size_t jpegFromPixels = 0;
  int jpegQuality = 90;
  std::string generator = "catoptric";
};

/// One .glb file: a flat list of nodes (instances, lights, cameras), meshes shared by instances, images
/// embedded, positions, normals and texture coordinates as float, indices as uint32, views aligned to 4
/// bytes, everything in the order of the scene's arrays; the bytes depend on the scene only. Extensions are
/// declared when used: KHR_lights_punctual, KHR_materials_unlit, _emissive_strength, _ior, _specular,
/// _clearcoat, KHR_texture_transform. Hints go to `extras.catoptric` of nodes and materials. Preconditions
/// (asserted): indices in range, attribute arrays as long as positions, worldFromMesh without shear. Not
/// written: Scene::warnings.
[[nodiscard]] std::vector<std::byte> makeGlb(const Scene& scene, const GlbOptions& options = {});

}  // namespace catoptric::scene
