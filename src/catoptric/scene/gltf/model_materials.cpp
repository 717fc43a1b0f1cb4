// SPDX-License-Identifier: Apache-2.0
// Images, samplers, textures and materials. Materials become scene::Material at once; only their texture
// indices are still those of the file.
#include <fmt/format.h>

#include <cmath>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

void readImage(Context&, const Element& element, Model& model) {
  Image image;
  image.name = element.findString("name");
  image.bufferView = element.findIndex("bufferView", model.bufferViews.size(), "buffer view");
  if (element.has("uri")) image.uri = element.getString("uri");
  if (image.uri.has_value() == (image.bufferView >= 0))
    element.fail("gltf.value", "an image must have either a URI or a buffer view");
  const std::string mimeType = element.findString("mimeType");
  if (image.bufferView >= 0) {
    if (mimeType.empty()) element.fail("gltf.missing", "an image in a buffer view needs a mimeType");
    if (model.bufferViews[std::size_t(image.bufferView)].byteStride != 0)
      element.fail("gltf.accessor_stride", "an image must not lie in a buffer view with a stride");
  }
  model.images.push_back(std::move(image));
}

Wrap readWrap(const Element& element, const char* key) {
  const std::size_t value = element.findInteger(key, 10497);
  switch (value) {
    case 10497:
      return Wrap::Repeat;
    case 33648:
      return Wrap::MirroredRepeat;
    case 33071:
      return Wrap::ClampToEdge;
    default:
      element.find(key)->fail("gltf.value", fmt::format("{} is no wrap mode", value));
  }
}

void readSampler(const Element& element, Model& model) {
  Sampler sampler;
  sampler.wrapU = readWrap(element, "wrapS");
  sampler.wrapV = readWrap(element, "wrapT");
  const std::size_t magnify = element.findInteger("magFilter", 9729);
  if (magnify != 9728 && magnify != 9729)
    element.find("magFilter")->fail("gltf.value", fmt::format("{} is no magnification filter", magnify));
  const std::size_t minify = element.findInteger("minFilter", 9987);
  const bool isPlain = minify == 9728 || minify == 9729;
  if (!isPlain && !(minify >= 9984 && minify <= 9987))
    element.find("minFilter")->fail("gltf.value", fmt::format("{} is no minification filter", minify));
  sampler.magnifyNearest = magnify == 9728;
  sampler.minifyNearest = minify == 9728 || minify == 9984 || minify == 9986;
  sampler.useMipmaps = !isPlain;
  model.samplers.push_back(sampler);
}

void readTexture(Context& context, const Element& element, Model& model) {
  TextureSource texture;
  texture.name = element.findString("name");
  texture.sampler = element.findIndex("sampler", model.samplers.size(), "sampler");
  texture.image = element.findIndex("source", model.images.size(), "image");
  if (const auto webp = element.findExtension("EXT_texture_webp"))
    texture.image = webp->getIndex("source", model.images.size(), "image");
  if (texture.image < 0)
    context.warn(fmt::format("a texture has no image in a format that can be read and was ignored (at {})",
                             element.pointer()));
  model.textures.push_back(std::move(texture));
}

/// KHR_texture_transform: translation * rotation * scale. A positive angle turns the coordinates
/// counter-clockwise as seen in the image, where v points down.
void readTextureTransform(const Element& extension, TextureSlot& slot) {
  const auto offset = extension.findNumbers<2>("offset", {0, 0});
  const auto scale = extension.findNumbers<2>("scale", {1, 1});
  const double angle = extension.findNumber("rotation", 0);
  slot.uvSet = int(extension.findInteger("texCoord", std::size_t(slot.uvSet), 0, 255));
  const double c = std::cos(angle), s = std::sin(angle);
  slot.uvFromMesh = mat3(
      glm::dmat3(c * scale[0], -s * scale[0], 0, s * scale[1], c * scale[1], 0, offset[0], offset[1], 1));
}

TextureSlot readSlot(Context& context, const Element& parent, const char* key, const Model& model) {
  TextureSlot slot;
  const std::optional<Element> info = parent.findObject(key);
  if (!info) return slot;
  slot.texture = info->getIndex("index", model.textures.size(), "texture");
  slot.uvSet = int(info->findInteger("texCoord", 0, 0, 255));
  if (const auto transform = info->findExtension("KHR_texture_transform"))
    readTextureTransform(*transform, slot);
  if (slot.uvSet > 1) {
    context.warn(
        fmt::format("textures with the texture coordinates TEXCOORD_{} are not supported and were ignored, "
                    "only sets 0 and 1 are",
                    slot.uvSet));
    return {};
  }
  return slot;
}

vec3 toVec3(const std::array<double, 3>& v) {
  return vec3(float(v[0]), float(v[1]), float(v[2]));
}

void readMetallicRoughness(Context& context, const Element& element, const Model& model, Material& material) {
  const auto base = element.findNumbers<4>("baseColorFactor", {1, 1, 1, 1}, 0, 1);
  material.baseColor = vec4(float(base[0]), float(base[1]), float(base[2]), float(base[3]));
  material.metallic = float(element.findNumber("metallicFactor", 1, 0, 1));
  material.roughness = float(element.findNumber("roughnessFactor", 1, 0, 1));
  material.baseColorTexture = readSlot(context, element, "baseColorTexture", model);
  material.metallicRoughnessTexture = readSlot(context, element, "metallicRoughnessTexture", model);
}

void warnIgnoredTexture(Context& context, const Element& extension, std::string_view key,
                        std::string_view extensionName) {
  if (extension.has(key))
    context.warn(fmt::format("{} of {} is not supported and was ignored", key, extensionName));
}

void readMaterialExtensions(Context& context, const Element& element, Material& material) {
  material.unlit = element.findExtension("KHR_materials_unlit").has_value();
  if (const auto extension = element.findExtension("KHR_materials_emissive_strength"))
    material.emissive *= float(extension->findNumber("emissiveStrength", 1, 0, 1e18));
  if (const auto extension = element.findExtension("KHR_materials_ior")) {
    material.ior = float(extension->findNumber("ior", 1.5, 0));
    if (material.ior > 0 && material.ior < 1)
      extension->find("ior")->fail("gltf.value", "an index of refraction must be 0 or at least 1");
  }
  if (const auto extension = element.findExtension("KHR_materials_specular")) {
    material.specular = float(extension->findNumber("specularFactor", 1, 0, 1));
    material.specularColor = toVec3(extension->findNumbers<3>("specularColorFactor", {1, 1, 1}, 0));
    warnIgnoredTexture(context, *extension, "specularTexture", "KHR_materials_specular");
    warnIgnoredTexture(context, *extension, "specularColorTexture", "KHR_materials_specular");
  }
  if (const auto extension = element.findExtension("KHR_materials_clearcoat")) {
    material.clearcoat = float(extension->findNumber("clearcoatFactor", 0, 0, 1));
    material.clearcoatRoughness = float(extension->findNumber("clearcoatRoughnessFactor", 0, 0, 1));
    for (const char* key : {"clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"})
      warnIgnoredTexture(context, *extension, key, "KHR_materials_clearcoat");
  }
  if (const auto extension = element.findExtension("KHR_materials_transmission")) {
    material.transmission = float(extension->findNumber("transmissionFactor", 0, 0, 1));
    warnIgnoredTexture(context, *extension, "transmissionTexture", "KHR_materials_transmission");
  }
  if (const auto extension = element.findExtension("KHR_materials_volume")) {
    material.thickness = float(extension->findNumber("thicknessFactor", 0, 0));
    material.attenuationColor = toVec3(extension->findNumbers<3>("attenuationColor", {1, 1, 1}, 0, 1));
    material.attenuationDistance = float(extension->findNumber("attenuationDistance", 0, 0));
  }
}

AlphaMode readAlphaMode(const Element& element) {
  const std::string mode = element.findString("alphaMode", "OPAQUE");
  if (mode == "OPAQUE") return AlphaMode::Opaque;
  if (mode == "MASK") return AlphaMode::Mask;
  if (mode == "BLEND") return AlphaMode::Blend;
  element.find("alphaMode")->fail("gltf.value", fmt::format("\"{}\" is no alpha mode", printable(mode)));
}

Material readMaterial(Context& context, const Element& element, const Model& model) {
  Material material;
  material.name = element.findString("name");
  if (const auto pbr = element.findObject("pbrMetallicRoughness"))
    readMetallicRoughness(context, *pbr, model, material);
  material.normalTexture = readSlot(context, element, "normalTexture", model);
  if (const auto info = element.findObject("normalTexture"))
    material.normalScale = float(info->findNumber("scale", 1));
  material.occlusionTexture = readSlot(context, element, "occlusionTexture", model);
  if (const auto info = element.findObject("occlusionTexture"))
    material.occlusionStrength = float(info->findNumber("strength", 1, 0, 1));
  material.emissiveTexture = readSlot(context, element, "emissiveTexture", model);
  material.emissive = toVec3(element.findNumbers<3>("emissiveFactor", {0, 0, 0}, 0, 1));
  material.alphaMode = readAlphaMode(element);
  material.alphaCutoff = float(element.findNumber("alphaCutoff", 0.5, 0));
  material.doubleSided = element.findBool("doubleSided", false);
  readMaterialExtensions(context, element, material);
  material.hint = readReflectorHint(context, element);
  return material;
}

}  // namespace

void readTextures(Context& context, const Element& root, Model& model) {
  forEachObject(root, "images",
                [&](const Element& element, std::size_t) { readImage(context, element, model); });
  forEachObject(root, "samplers", [&](const Element& element, std::size_t) { readSampler(element, model); });
  forEachObject(root, "textures",
                [&](const Element& element, std::size_t) { readTexture(context, element, model); });
}

void readMaterials(Context& context, const Element& root, Model& model) {
  forEachObject(root, "materials", [&](const Element& element, std::size_t) {
    model.materials.push_back(readMaterial(context, element, model));
  });
}

ReflectorHint readReflectorHint(Context& context, const Element& owner) {
  ReflectorHint hint;
  const std::optional<Element> extras = owner.find("extras");
  const std::optional<Element> ours = extras ? extras->findObject("catoptric") : std::nullopt;
  if (!ours) return hint;
  if (ours->has("reflector")) hint.reflector = ours->findBool("reflector", false);
  if (ours->has("shell")) hint.shell = ours->findBool("shell", false);
  if (ours->has("morphed")) hint.morphed = ours->findBool("morphed", false);
  if (ours->has("reflectivity")) hint.reflectivity = float(ours->getNumber("reflectivity", 0, 1));
  if (ours->has("shape")) {
    hint.shape = ours->getString("shape");
    if (hint.shape != "plane" && hint.shape != "sphere" && hint.shape != "cylinder" && hint.shape != "cone" &&
        hint.shape != "mesh")
      ours->find("shape")->fail(
          "gltf.value", fmt::format("\"{}\" is no shape; known are plane, sphere, cylinder, cone and mesh",
                                    printable(*hint.shape)));
  }
  for (const auto& [key, value] : ours->json().items())
    if (key != "reflector" && key != "shell" && key != "morphed" && key != "reflectivity" && key != "shape")
      context.warn(fmt::format("extras.catoptric has the unknown member \"{}\", which was ignored (at {})",
                               printable(key), ours->pointer()));
  return hint;
}

}  // namespace catoptric::scene::gltf
