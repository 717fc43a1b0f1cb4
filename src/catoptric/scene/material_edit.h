// SPDX-License-Identifier: Apache-2.0
// Values of a material that can be changed while the scene is being drawn.
#pragma once

#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

struct MaterialValues {
  vec3 tint{1.0f};  ///< linear; the base colour without its alpha
  float metallic = 1, roughness = 1;
  float reflectivity = 1;  ///< ReflectorHint::reflectivity: of the mirror lobe, where the material mirrors

  bool operator==(const MaterialValues&) const = default;
};

[[nodiscard]] MaterialValues readMaterialValues(const Material& material);
void writeMaterialValues(const MaterialValues& values, Material& material);

/// Writes the values to the material, and to what `world` knows of its mirrors. True: the same triangles are
/// mirrors as before, the world is as good as one made anew. False: some mirror begins or ceases to be one
/// (or turns into a refractor); the world must be made anew by makeWorldGeometry(). `options` are those that
/// it was made with.
[[nodiscard]] bool changeMaterial(Scene& scene, WorldGeometry& world, const ReflectorOptions& options,
                                  int material, const MaterialValues& values);

}  // namespace catoptric::scene
