// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace catoptric::scene::gltf {
namespace {

/// Extensions that we read, or that change nothing of what we show.
constexpr std::array kSupportedExtensions = {
    "EXT_mesh_gpu_instancing", "EXT_texture_webp",
    "KHR_lights_punctual",     "KHR_materials_clearcoat",
    "KHR_materials_ior",       "KHR_materials_emissive_strength",
    "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",     "KHR_materials_variants",
    "KHR_materials_volume",    "KHR_mesh_quantization",
    "KHR_texture_transform",   "KHR_xmp",
    "KHR_xmp_json_ld",
};

bool isSupported(std::string_view extension) {
  return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), extension) !=
         kSupportedExtensions.end();
}

/// "2.0" -> {2, 0}; throws for anything else.
std::pair<int, int> parseVersion(const Element& owner, const char* key) {
  const std::string text = owner.getString(key);
  const char* const end = text.data() + text.size();
  int major = 0, minor = 0;
  const auto first = std::from_chars(text.data(), end, major);
  const bool hasDot = first.ec == std::errc() && first.ptr != end && *first.ptr == '.';
  const auto second = hasDot ? std::from_chars(first.ptr + 1, end, minor) : first;
  if (!hasDot || second.ec != std::errc() || second.ptr != end || major < 0 || minor < 0)
    owner.find(key)->fail("gltf.version",
                          fmt::format("\"{}\" is not a version such as \"2.0\"", printable(text)));
  return {major, minor};
}

void checkVersion(const Element& root) {
  const Element asset = root.getObject("asset");
  const auto version = parseVersion(asset, "version");
  if (version.first != 2)
    asset.find("version")->fail(
        "gltf.version",
        fmt::format("glTF {}.{} is not supported, only glTF 2.0", version.first, version.second),
        "convert it, for example with Blender");
  if (!asset.has("minVersion")) return;
  const auto least = parseVersion(asset, "minVersion");
  if (least > version)
    asset.find("minVersion")->fail("gltf.version", "the minimum version is greater than the version itself");
  if (least > std::pair(2, 0))
    asset.find("minVersion")
        ->fail("gltf.version", fmt::format("the file needs a reader of glTF {}.{}, this one reads 2.0",
                                           least.first, least.second));
}

}  // namespace

std::size_t componentBytes(ComponentType type) {
  switch (type) {
    case ComponentType::Int8:
    case ComponentType::Uint8:
      return 1;
    case ComponentType::Int16:
    case ComponentType::Uint16:
      return 2;
    default:
      return 4;
  }
}

std::size_t componentCount(ElementType type) {
  constexpr std::array<std::size_t, 7> kCounts = {1, 2, 3, 4, 4, 9, 16};
  return kCounts[std::size_t(type)];
}

std::size_t elementBytes(ElementType element, ComponentType component) {
  const std::size_t bytes = componentBytes(component);
  const auto columns = [bytes](std::size_t n) { return n * ((n * bytes + 3) / 4 * 4); };
  if (element == ElementType::Mat2) return columns(2);
  if (element == ElementType::Mat3) return columns(3);
  return componentCount(element) * bytes;
}

int findAttribute(const Attributes& attributes, std::string_view semantic) {
  for (const auto& [name, accessor] : attributes)
    if (name == semantic) return accessor;
  return -1;
}

void readAssetAndExtensions(Context& context, const Element& root, Model& model) {
  checkVersion(root);
  if (const auto required = root.findArray("extensionsRequired"))
    for (std::size_t i = 0; i < required->size(); ++i) {
      const Element entry = (*required)[i];
      const std::string extension = entry.asString();
      if (!isSupported(extension))
        entry.fail(
            "gltf.extension_required",
            fmt::format("the file needs the extension {}, which is not supported", printable(extension)),
            "export it without that extension");
      model.quantized |= extension == "KHR_mesh_quantization";
    }
  if (const auto used = root.findArray("extensionsUsed"))
    for (std::size_t i = 0; i < used->size(); ++i) {
      const std::string extension = (*used)[i].asString();
      if (!isSupported(extension))
        context.warn(
            fmt::format("the optional extension {} is not supported and was ignored", printable(extension)));
      model.quantized |= extension == "KHR_mesh_quantization";
    }
}

Model readModel(Context& context, const Element& root, const Container& container) {
  Model model;
  readAssetAndExtensions(context, root, model);
  readBuffers(context, root, model, container);
  readAccessors(context, root, model);
  readTextures(context, root, model);
  readMaterials(context, root, model);
  readMeshes(context, root, model);
  readCamerasAndLights(context, root, model);
  readNodes(context, root, model);
  readSkins(context, root, model);
  readScenes(context, root, model);
  readAnimations(context, root, model);
  return model;
}

}  // namespace catoptric::scene::gltf
