// SPDX-License-Identifier: Apache-2.0
// The scene all around a point, as cube maps: radiance with mip levels, and at full size what is seen.
#pragma once

#include <memory>

#include "catoptric/raster/reflection_method.h"

namespace catoptric::raster {

struct SceneCube {
  explicit SceneCube(int sizeTexels);
  [[nodiscard]] std::size_t bytes() const;

  gl::Texture color;
  gl::Texture position;  ///< world point and its distance from the centre; direction and kSkyPath at the sky
  gl::Texture ids;       ///< r as in shaders/raster/level_pixels.glsl
  dvec3 centre{0};
};

/// Draws the scene six times.
class SceneCubeCapture {
 public:
  void draw(FrameContext& frame, const dvec3& centre, double nearPlane, std::uint32_t excludedReflector,
            SceneCube& cube);

 private:
  std::unique_ptr<Level> face_;
};

}  // namespace catoptric::raster
