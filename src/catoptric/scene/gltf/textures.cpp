// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/textures.h"

#include <fmt/format.h>

#include <map>
#include <tuple>

#include "catoptric/scene/gltf/uri.h"

namespace catoptric::scene::gltf {
namespace {

class TextureTable {
 public:
  TextureTable(const Data& data, Scene& scene) : data_(data), scene_(scene) {}

  /// Index into Scene::textures for a texture of the file; -1 if it has no image that we can read.
  int findOrRead(int texture) {
    const TextureSource& source = data_.model().textures[std::size_t(texture)];
    if (source.image < 0) return -1;
    const Sampler sampler =
        source.sampler >= 0 ? data_.model().samplers[std::size_t(source.sampler)] : Sampler();
    const auto key = std::tuple(source.image, sampler.wrapU, sampler.wrapV, sampler.magnifyNearest,
                                sampler.minifyNearest, sampler.useMipmaps);
    const auto [entry, isNew] = textures_.emplace(key, int(scene_.textures.size()));
    if (!isNew) return entry->second;
    const Image& image = data_.model().images[std::size_t(source.image)];
    const std::string& name = !source.name.empty()  ? source.name
                              : !image.name.empty() ? image.name
                                                    : image.uri.value_or("");
    scene_.textures.push_back({.name = name.starts_with("data:") ? std::string() : name,
                               .image = readOnce(source.image),
                               .wrapU = sampler.wrapU,
                               .wrapV = sampler.wrapV,
                               .magnifyNearest = sampler.magnifyNearest,
                               .minifyNearest = sampler.minifyNearest,
                               .useMipmaps = sampler.useMipmaps});
    images_.emplace(source.image, entry->second);
    return entry->second;
  }

  /// Images that no material uses are not decoded, but their URIs must keep the rules.
  void checkUnusedImages() const {
    for (std::size_t i = 0; i < data_.model().images.size(); ++i) {
      const std::optional<std::string>& uri = data_.model().images[i].uri;
      if (!uri || images_.contains(int(i))) continue;
      const std::string pointer = fmt::format("/images/{}/uri", i);
      if (isDataUri(*uri))
        (void)decodeDataUri(data_.context(), *uri, pointer);
      else
        (void)checkFileUri(data_.context(), *uri, pointer);
    }
  }

 private:
  /// Two samplers of one image share the decoding, not the pixels.
  core::ImageRgba8 readOnce(int image) {
    const auto known = images_.find(image);
    if (known == images_.end()) return data_.readImage(image);
    const core::ImageRgba8& pixels = scene_.textures[std::size_t(known->second)].image;
    data_.context().charge(pixels.size(), sizeof(glm::u8vec4), fmt::format("/images/{}", image));
    return pixels;
  }

  const Data& data_;
  Scene& scene_;
  std::map<std::tuple<int, Wrap, Wrap, bool, bool, bool>, int> textures_;
  std::map<int, int> images_;  ///< Image of the file to a texture that has its pixels.
};

}  // namespace

void importMaterials(const Data& data, Scene& scene) {
  TextureTable table(data, scene);
  for (Material material : data.model().materials) {
    for (TextureSlot* slot : {&material.baseColorTexture, &material.metallicRoughnessTexture,
                              &material.normalTexture, &material.occlusionTexture, &material.emissiveTexture})
      if (slot->texture >= 0) slot->texture = table.findOrRead(slot->texture);
    scene.materials.push_back(std::move(material));
  }
  table.checkUnusedImages();
  Material fallback;
  fallback.name = "default";
  scene.materials.push_back(std::move(fallback));
}

}  // namespace catoptric::scene::gltf
