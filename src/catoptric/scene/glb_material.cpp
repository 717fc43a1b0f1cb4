// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/glb_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

namespace catoptric::scene {
namespace {

using Json = nlohmann::json;

Json numbers(std::span<const float> values) {
  Json array = Json::array();
  for (float v : values) array.push_back(makeNumber(v));
  return array;
}

Json slotJson(const TextureSlot& slot, ExtensionNames& used) {
  Json json = {{"index", slot.texture}};
  if (slot.uvSet != 0) json["texCoord"] = slot.uvSet;
  if (slot.uvFromMesh == mat3(1.0f)) return json;
  // uvFromMesh = move * turn * scale, as the extension composes it.
  const vec2 columnU(slot.uvFromMesh[0]), columnV(slot.uvFromMesh[1]);
  const float rotation = std::atan2(-columnU.y, columnU.x);
  json["extensions"]["KHR_texture_transform"] = {
      {"offset", {makeNumber(slot.uvFromMesh[2].x), makeNumber(slot.uvFromMesh[2].y)}},
      {"rotation", makeNumber(rotation == 0.0f ? 0.0f : rotation)},
      {"scale", {makeNumber(glm::length(columnU)), makeNumber(glm::length(columnV))}}};
  used.insert("KHR_texture_transform");
  return json;
}

void setExtension(Json& json, const char* name, Json value, ExtensionNames& used) {
  json["extensions"][name] = std::move(value);
  used.insert(name);
}

void setSurface(Json& json, const Material& m, ExtensionNames& used) {
  Json& surface = json["pbrMetallicRoughness"];
  surface["baseColorFactor"] = numbers(std::span<const float>(&m.baseColor.x, 4));
  surface["metallicFactor"] = makeNumber(m.metallic);
  surface["roughnessFactor"] = makeNumber(m.roughness);
  if (m.baseColorTexture.texture >= 0) surface["baseColorTexture"] = slotJson(m.baseColorTexture, used);
  if (m.metallicRoughnessTexture.texture >= 0)
    surface["metallicRoughnessTexture"] = slotJson(m.metallicRoughnessTexture, used);
  if (m.normalTexture.texture >= 0) {
    json["normalTexture"] = slotJson(m.normalTexture, used);
    json["normalTexture"]["scale"] = makeNumber(m.normalScale);
  }
  if (m.occlusionTexture.texture >= 0) {
    json["occlusionTexture"] = slotJson(m.occlusionTexture, used);
    json["occlusionTexture"]["strength"] = makeNumber(m.occlusionStrength);
  }
}

void setEmission(Json& json, const Material& m, ExtensionNames& used) {
  if (m.emissiveTexture.texture >= 0) json["emissiveTexture"] = slotJson(m.emissiveTexture, used);
  if (m.emissive == vec3(0.0f)) return;
  const float strength = std::max({m.emissive.x, m.emissive.y, m.emissive.z, 1.0f});
  json["emissiveFactor"] = makeVectorJson(m.emissive / strength);
  if (strength > 1)
    setExtension(json, "KHR_materials_emissive_strength", {{"emissiveStrength", makeNumber(strength)}}, used);
}

void setTransmission(Json& json, const Material& m, ExtensionNames& used) {
  if (m.transmission > 0)
    setExtension(json, "KHR_materials_transmission", {{"transmissionFactor", makeNumber(m.transmission)}},
                 used);
  if (m.thickness <= 0) return;
  Json volume{{"thicknessFactor", makeNumber(m.thickness)}};
  if (m.attenuationDistance > 0) {
    volume["attenuationDistance"] = makeNumber(m.attenuationDistance);
    volume["attenuationColor"] = makeVectorJson(m.attenuationColor);
  }
  setExtension(json, "KHR_materials_volume", volume, used);
}

}  // namespace

double makeNumber(float value) {
  return std::stod(fmt::format("{}", value));
}

Json makeVectorJson(const vec3& v) {
  return numbers(std::span<const float>(&v.x, 3));
}

Json makeHintJson(const ReflectorHint& hint) {
  Json json;
  if (hint.reflector) json["reflector"] = *hint.reflector;
  if (hint.shape) json["shape"] = *hint.shape;
  if (hint.reflectivity) json["reflectivity"] = makeNumber(*hint.reflectivity);
  if (hint.morphed) json["morphed"] = *hint.morphed;
  if (hint.shell) json["shell"] = *hint.shell;
  return json;
}

Json makeMaterialJson(const Material& m, ExtensionNames& used) {
  Json json;
  if (!m.name.empty()) json["name"] = m.name;
  setSurface(json, m, used);
  setEmission(json, m, used);
  if (m.alphaMode != AlphaMode::Opaque) json["alphaMode"] = m.alphaMode == AlphaMode::Mask ? "MASK" : "BLEND";
  if (m.alphaMode == AlphaMode::Mask) json["alphaCutoff"] = makeNumber(m.alphaCutoff);
  if (m.doubleSided) json["doubleSided"] = true;
  if (m.unlit) setExtension(json, "KHR_materials_unlit", Json::object(), used);
  if (m.ior != 1.5f) setExtension(json, "KHR_materials_ior", {{"ior", makeNumber(m.ior)}}, used);
  if (m.specular != 1.0f || m.specularColor != vec3(1.0f))
    setExtension(json, "KHR_materials_specular",
                 {{"specularFactor", makeNumber(m.specular)},
                  {"specularColorFactor", makeVectorJson(m.specularColor)}},
                 used);
  if (m.clearcoat > 0)
    setExtension(json, "KHR_materials_clearcoat",
                 {{"clearcoatFactor", makeNumber(m.clearcoat)},
                  {"clearcoatRoughnessFactor", makeNumber(m.clearcoatRoughness)}},
                 used);
  setTransmission(json, m, used);
  const Json hint = makeHintJson(m.hint);
  if (!hint.is_null()) json["extras"]["catoptric"] = hint;
  return json;
}

}  // namespace catoptric::scene
