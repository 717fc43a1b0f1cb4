// SPDX-License-Identifier: Apache-2.0
// What every imported scene must hold, whatever the file was; shared by the unit tests and the fuzzer.
#pragma once

#include <cmath>
#include <string>

#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf_test {

template <class Vector>
bool isFiniteVector(const Vector& v) {
  for (int i = 0; i < Vector::length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

inline std::string checkPrimitive(const Scene& scene, const MeshPrimitive& p) {
  const std::size_t n = p.positions.size();
  if (n == 0 || p.indices.empty() || p.indices.size() % 3 != 0) return "empty primitive";
  if (p.normals.size() != n) return "normals";
  for (std::size_t size : {p.tangents.size(), p.uv[0].size(), p.uv[1].size(), p.colors.size()})
    if (size != 0 && size != n) return "attribute length";
  for (const auto i : p.indices)
    if (i >= n) return "index out of range";
  for (const auto& v : p.positions)
    if (!isFiniteVector(v)) return "non-finite position";
  for (const auto& v : p.normals)
    if (!(std::abs(glm::length(v) - 1.0f) < 1e-4f)) return "normal not unit";
  for (const auto& v : p.tangents)
    if (!(std::abs(glm::length(vec3(v)) - 1.0f) < 1e-4f) || std::abs(v.w) != 1.0f) return "tangent";
  for (const auto& uv : p.uv)
    for (const auto& v : uv)
      if (!isFiniteVector(v)) return "non-finite uv";
  for (const auto& v : p.colors)
    for (int c = 0; c < 4; ++c)
      if (!(v[c] >= 0 && v[c] <= 1)) return "colour";
  if (p.material < 0 || p.material >= int(scene.materials.size())) return "material";
  return {};
}

/// Every promise that scene.h makes; empty if all are kept.
inline std::string checkScene(const Scene& scene) {
  if (scene.materials.empty()) return "no materials";
  for (const Mesh& mesh : scene.meshes)
    for (const MeshPrimitive& primitive : mesh.primitives)
      if (std::string fault = checkPrimitive(scene, primitive); !fault.empty()) return fault;
  for (const Instance& instance : scene.instances) {
    if (instance.mesh < 0 || instance.mesh >= int(scene.meshes.size())) return "instance";
    for (int c = 0; c < 4; ++c)
      if (!isFiniteVector(instance.worldFromMesh[c])) return "instance matrix";
  }
  for (const Material& material : scene.materials)
    for (const TextureSlot* slot :
         {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
          &material.occlusionTexture, &material.emissiveTexture})
      if (slot->texture >= int(scene.textures.size()) || slot->uvSet < 0 || slot->uvSet > 1)
        return "texture slot";
  for (const Texture& texture : scene.textures)
    if (texture.image.isEmpty()) return "empty texture";
  for (const Camera& camera : scene.cameras)
    if (!isFiniteVector(camera.eye) || !isFiniteVector(camera.target) || !isFiniteVector(camera.up) ||
        !(camera.fovYRadians > 0))
      return "camera";
  for (const Light& light : scene.lights)
    if (!isFiniteVector(light.direction) || !isFiniteVector(light.color)) return "light";
  for (const std::string& line : scene.warnings)
    if (line.find('\n') != std::string::npos) return "warning of two lines";
  return {};
}

}  // namespace catoptric::scene::gltf_test
