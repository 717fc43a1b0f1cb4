// SPDX-License-Identifier: Apache-2.0
// Steps: 1 what the rule of reflectors said of the material as it was, 2 the new values, 3 what it says now,
// for each part: the instance has a say in it.
#include "catoptric/scene/material_edit.h"

#include <vector>

#include "catoptric/scene/reflector_rule.h"

namespace catoptric::scene {
namespace {

/// By part; of other materials: the default.
std::vector<ReflectorDecision> decideParts(const Scene& scene, const WorldGeometry& world,
                                           const ReflectorOptions& options, int material) {
  const ReflectorRule rule(scene, options, material);
  std::vector<ReflectorDecision> decisions(world.parts.size());
  for (std::size_t i = 0; i < world.parts.size(); ++i)
    if (world.parts[i].material == material)
      decisions[i] = rule.decide(material, scene.instances[world.parts[i].object].hint);
  return decisions;
}

}  // namespace

MaterialValues readMaterialValues(const Material& material) {
  return {vec3(material.baseColor), material.metallic, material.roughness,
          material.hint.reflectivity.value_or(1.0f)};
}

void writeMaterialValues(const MaterialValues& values, Material& material) {
  material.baseColor = vec4(values.tint, material.baseColor.a);
  material.metallic = values.metallic;
  material.roughness = values.roughness;
  if (material.hint.reflectivity || values.reflectivity != 1.0f)
    material.hint.reflectivity = values.reflectivity;
}

bool changeMaterial(Scene& scene, WorldGeometry& world, const ReflectorOptions& options, int material,
                    const MaterialValues& values) {
  // 1
  const std::vector<ReflectorDecision> before = decideParts(scene, world, options, material);
  // 2
  writeMaterialValues(values, scene.materials[std::size_t(material)]);
  // 3
  const std::vector<ReflectorDecision> after = decideParts(scene, world, options, material);
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    if (before[i].isReflector != after[i].isReflector || before[i].isRefractor != after[i].isRefractor)
      return false;
    if (world.parts[i].material != material || world.parts[i].reflector == core::kNoId) continue;
    Reflector& reflector = world.reflectors[world.parts[i].reflector];
    reflector.reason = after[i].reason;
    reflector.reflectivity = after[i].reflectivity;
    reflector.clearcoat = after[i].clearcoat;
  }
  return true;
}

}  // namespace catoptric::scene
