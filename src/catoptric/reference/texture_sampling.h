// SPDX-License-Identifier: Apache-2.0
// Textures and the environment read as the rasterizer reads them: two integer mip levels blended (see
// shaders/raster/material.glsl and environment_lookup.glsl).
#pragma once

#include <span>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/reference/ray_differential.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/material.h"

namespace catoptric::reference {

/// A texture in one of its two roles: colour (sRGB, decoded to linear before it is filtered) or data
/// (linear).
class SampledTexture {
 public:
  SampledTexture(const scene::Texture& texture, bool srgb);

  /// `change` are the derivatives of uv per pixel.
  [[nodiscard]] vec4 sample(const vec2& uv, const PerPixel<vec2>& change) const;
  [[nodiscard]] bool isEmpty() const { return levels_.empty(); }

 private:
  [[nodiscard]] vec4 sampleLevel(std::size_t level, const vec2& uv) const;
  [[nodiscard]] vec4 fetch(const core::ImageRgba8& image, int x, int y) const;

  std::vector<core::ImageRgba8> levels_;
  scene::Wrap wrapU_, wrapV_;
  bool magnifyNearest_, minifyNearest_, srgb_;
};

/// Radiance of the environment in a unit direction that changes by `change` per pixel.
[[nodiscard]] vec3 sampleEnvironment(const scene::Environment& environment, const vec3& direction,
                                     const PerPixel<vec3>& change);
/// The environment blurred for a roughness in 0..1.
[[nodiscard]] vec3 samplePrefiltered(const scene::Environment& environment, const vec3& direction,
                                     float roughness);
/// Irradiance / pi at a unit normal.
[[nodiscard]] vec3 sampleIrradiance(const scene::Environment& environment, const vec3& normal);

}  // namespace catoptric::reference
