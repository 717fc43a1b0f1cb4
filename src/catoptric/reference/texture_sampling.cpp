// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reference/texture_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/core/tone_map.h"
#include "catoptric/scene/shading.h"
#include "catoptric/scene/texture_mips.h"

namespace catoptric::reference {
namespace {

const std::array<float, 256>& linearFromByte(bool srgb) {
  static const auto tables = [] {
    std::array<std::array<float, 256>, 2> t{};
    for (int i = 0; i < 256; ++i) {
      t[0][i] = float(i) / 255.0f;
      t[1][i] = core::linearFromSrgb(t[0][i]);
    }
    return t;
  }();
  return tables[srgb ? 1 : 0];
}

/// A coordinate brought near the texture, so that it can become an integer whatever it was.
float tame(float coordinate, scene::Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0f;
  if (wrap == scene::Wrap::ClampToEdge) return std::clamp(coordinate, -2.0f, 3.0f);
  return coordinate - 2.0f * std::floor(0.5f * coordinate);  // both repeating modes have a period of 2
}

/// `i` comes from a tamed coordinate: -1 <= i <= 2 size when it repeats. No divisions: this is hot.
int wrapTexel(int i, int size, scene::Wrap wrap) {
  if (wrap == scene::Wrap::ClampToEdge) return std::clamp(i, 0, size - 1);
  if (wrap == scene::Wrap::MirroredRepeat) {
    if (i < 0 || i >= 2 * size) return 0;
    return i < size ? i : 2 * size - 1 - i;
  }
  if (i < 0) i += size;
  while (i >= size) i -= size;
  return i;
}

/// Bilinear; the column wraps around, the row is clamped.
vec3 sampleLatLong(const core::ImageRgbF& image, const vec2& uv) {
  const float x = uv.x * float(image.width()) - 0.5f, y = uv.y * float(image.height()) - 0.5f;
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const int w = image.width(), h = image.height();
  int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  int x1 = x0 + 1, y1 = std::clamp(y0 + 1, 0, h - 1);
  y0 = std::clamp(y0, 0, h - 1);
  if (x0 < 0 || x0 >= w) x0 = ((x0 % w) + w) % w;
  if (x1 >= w) x1 %= w;
  const vec3 top = glm::mix(image.at(x0, y0), image.at(x1, y0), fx);
  const vec3 bottom = glm::mix(image.at(x0, y1), image.at(x1, y1), fx);
  return glm::mix(top, bottom, fy);
}

}  // namespace

SampledTexture::SampledTexture(const scene::Texture& texture, bool srgb)
    : wrapU_(texture.wrapU),
      wrapV_(texture.wrapV),
      magnifyNearest_(texture.magnifyNearest),
      minifyNearest_(texture.minifyNearest),
      srgb_(srgb) {
  if (texture.useMipmaps)
    levels_ = scene::makeMipChain(texture.image, srgb);
  else if (!texture.image.isEmpty())
    levels_ = {texture.image};
}

vec4 SampledTexture::fetch(const core::ImageRgba8& image, int x, int y) const {
  const auto& texel = image.at(x, y);
  const auto& table = linearFromByte(srgb_);
  return {table[texel.r], table[texel.g], table[texel.b], float(texel.a) * (1.0f / 255.0f)};
}

vec4 SampledTexture::sampleLevel(std::size_t level, const vec2& uv) const {
  const core::ImageRgba8& image = levels_[level];
  const int w = image.width(), h = image.height();
  const float x = uv.x * float(w), y = uv.y * float(h);
  // Like GL: level 0 is magnified, the others are minified.
  if (level == 0 ? magnifyNearest_ : minifyNearest_)
    return fetch(image, wrapTexel(int(std::floor(x)), w, wrapU_), wrapTexel(int(std::floor(y)), h, wrapV_));
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float fx = x - 0.5f - left, fy = y - 0.5f - top;
  const int x0 = wrapTexel(int(left), w, wrapU_), x1 = wrapTexel(int(left) + 1, w, wrapU_);
  const int y0 = wrapTexel(int(top), h, wrapV_), y1 = wrapTexel(int(top) + 1, h, wrapV_);
  return glm::mix(glm::mix(fetch(image, x0, y0), fetch(image, x1, y0), fx),
                  glm::mix(fetch(image, x0, y1), fetch(image, x1, y1), fx), fy);
}

vec4 SampledTexture::sample(const vec2& uv, const PerPixel<vec2>& change) const {
  const vec2 size(float(levels_[0].width()), float(levels_[0].height()));
  const float maxLod = float(levels_.size() - 1);
  const float lod = scene::glsl::textureLodFromDerivatives(change.dx * size, change.dy * size, maxLod);
  const float lower = std::floor(lod);
  const vec2 tamed(tame(uv.x, wrapU_), tame(uv.y, wrapV_));
  const vec4 fine = sampleLevel(std::size_t(lower), tamed);
  if (lod == lower) return fine;
  return glm::mix(fine, sampleLevel(std::size_t(lower) + 1, tamed), lod - lower);
}

vec3 sampleEnvironment(const scene::Environment& environment, const vec3& direction,
                       const PerPixel<vec3>& change) {
  const auto& levels = environment.radiance;
  if (levels.empty()) return vec3(0);
  const vec2 uv = scene::glsl::latLongFromDirection(direction);
  const float lod = std::min(scene::glsl::environmentLod(change.dx, change.dy, float(levels[0].width())),
                             float(levels.size() - 1));
  const float lower = std::floor(lod);
  const vec3 fine = sampleLatLong(levels[std::size_t(lower)], uv);
  if (lod == lower) return fine;
  return glm::mix(fine, sampleLatLong(levels[std::size_t(lower) + 1], uv), lod - lower);
}

vec3 samplePrefiltered(const scene::Environment& environment, const vec3& direction, float roughness) {
  const auto& layers = environment.prefiltered;
  if (layers.empty()) return vec3(0);
  const vec2 uv = scene::glsl::latLongFromDirection(direction);
  const float last = float(layers.size() - 1), layer = std::clamp(roughness, 0.0f, 1.0f) * last;
  const float lower = std::floor(layer);
  const vec3 fine = sampleLatLong(layers[std::size_t(lower)], uv);
  if (layer == lower) return fine;
  return glm::mix(fine, sampleLatLong(layers[std::size_t(lower) + 1], uv), layer - lower);
}

vec3 sampleIrradiance(const scene::Environment& environment, const vec3& normal) {
  const auto& c = environment.irradiance;
  return scene::glsl::evaluateIrradiance(c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], normal);
}

}  // namespace catoptric::reference
