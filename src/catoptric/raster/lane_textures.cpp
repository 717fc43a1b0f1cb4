// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/lane_textures.h"

#include <algorithm>

namespace catoptric::raster {

LaneTexture::LaneTexture(const scene::Texture& texture, const std::vector<core::ImageRgba8>& levels,
                         bool isSrgb)
    : width_(levels[0].width()),
      height_(levels[0].height()),
      levels_(int(levels.size())),
      wrapU_(texture.wrapU),
      wrapV_(texture.wrapV),
      magnifyNearest_(texture.magnifyNearest),
      minifyNearest_(texture.minifyNearest),
      isSrgb_(isSrgb) {
  std::size_t count = 0;
  for (const core::ImageRgba8& level : levels) count += level.size();
  texels_.reserve(count);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    offsets_[i] = std::int32_t(texels_.size());
    for (const auto& t : levels[i].pixels())
      texels_.push_back(std::uint32_t(t.r) | std::uint32_t(t.g) << 8u | std::uint32_t(t.b) << 16u |
                        std::uint32_t(t.a) << 24u);
  }
}

namespace {

constexpr std::size_t kMostBlurred = 64;  // of 512 kB

}  // namespace

LaneEnvironment::LaneEnvironment(const scene::Environment& environment) {
  for (const core::ImageRgbF& image : environment.radiance)
    levels_.push_back({&image.data()->x, image.width(), image.height()});
  for (const core::ImageRgbF& image : environment.prefiltered) {
    std::vector<vec4>& texels = layerTexels_.emplace_back();
    texels.reserve(image.size());
    for (const vec3& texel : image.pixels()) texels.emplace_back(texel, 0.0f);
    layers_.push_back({&texels.data()->x, image.width(), image.height()});
  }
}

void LaneEnvironment::addBlurred(float roughness) {
  if (blurred_.size() >= kMostBlurred || findBlurred(roughness)) return;
  const float layer = std::clamp(roughness, 0.0f, 1.0f) * lastLayer();
  const auto lower = std::size_t(layer), upper = std::min(lower + 1, layers_.size() - 1);
  Blurred added{roughness, std::vector<vec4>(layerTexels_[lower].size()), layers_[lower]};
  for (std::size_t i = 0; i < added.texels.size(); ++i)
    added.texels[i] = glm::mix(layerTexels_[lower][i], layerTexels_[upper][i], layer - float(lower));
  added.image.texels = &added.texels.data()->x;
  blurred_.push_back(std::move(added));
}

const LaneLatLong* LaneEnvironment::findBlurred(float roughness) const {
  for (const Blurred& blurred : blurred_)
    if (blurred.roughness == roughness) return &blurred.image;
  return nullptr;
}

}  // namespace catoptric::raster
