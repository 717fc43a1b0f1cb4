// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/lane_textures.h"

#include <cstring>

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

LaneEnvironment::LaneEnvironment(const std::vector<core::ImageRgbF>& images) {
  for (const core::ImageRgbF& image : images)
    images_.push_back({&image.data()->x, image.width(), image.height()});
}

}  // namespace catoptric::raster
