// SPDX-License-Identifier: Apache-2.0
// The scene's textures where the processor shades, for eight pixels at once: the texels that GL has, read as
// shaders read them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/core/lane_vectors.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/material.h"

namespace catoptric::raster {

namespace lanes = core::lanes;

/// Colour from its sRGB code, both 0 to 1. Error below 1e-5.
CATOPTRIC_INLINE lanes::Float linearFromSrgb(lanes::Float code) {
  const lanes::Float bright = lanes::evaluate(code, 0.00091975503f, 0.032948937f, 0.51325449f, 0.71004817f,
                                              -0.42192918f, 0.21590615f, -0.051152303f);
  return lanes::choose(code > 0.04045f, bright, code * (1.0f / 12.92f));
}

/// 0 to size - 1.
CATOPTRIC_INLINE core::EightInts keepWithin(const core::EightInts& i, const core::EightInts& size) {
  const core::EightInts most = i < size ? i : size - 1;
  return most > 0 ? most : core::EightInts{};
}

/// A texture in one of its two roles: colour (sRGB, linear before it is filtered) or data.
class LaneTexture {
 public:
  /// `levels`: not empty, each half as large as the one before (scene::makeMipChain()).
  LaneTexture(const scene::Texture& texture, const std::vector<core::ImageRgba8>& levels, bool isSrgb);

  [[nodiscard]] ivec2 size() const { return {width_, height_}; }

  /// GLSL's textureLod() at a whole level; beyond the last one, which lanes may ask for, that one.
  CATOPTRIC_INLINE lanes::Vec4 sample(const lanes::Vec2& uv, lanes::Float level) const {
    using namespace lanes;
    const core::EightInts number = keepWithin(toInts(level), core::EightInts{} + levels_);
    const Mask isFirst(number == 0);
    const Mask isNearest = (isFirst && Mask(magnifyNearest_)) || (!isFirst && Mask(minifyNearest_));
    const Float centre = choose(isNearest, 0.0f, 0.5f);
    const Taps x = findTaps(uv.x, shrink(width_, number), centre, wrapU_);
    const Taps y = findTaps(uv.y, shrink(height_, number), centre, wrapV_);
    core::EightInts first;
    for (int i = 0; i < core::kLanes; ++i) first[i] = offsets_[std::size_t(number[i])];
    const core::EightInts upper = first + y.lower * x.size, lower = first + y.upper * x.size;
    const Float right = choose(isNearest, 0.0f, x.fraction), below = choose(isNearest, 0.0f, y.fraction);
    const Float rest = 1.0f - right;
    return (fetch(upper + x.lower) * rest + fetch(upper + x.upper) * right) * (1.0f - below) +
           (fetch(lower + x.lower) * rest + fetch(lower + x.upper) * right) * below;
  }

 private:
  /// Two neighbouring texels along one axis.
  struct Taps {
    core::EightInts lower, upper, size;
    lanes::Float fraction;
  };

  CATOPTRIC_INLINE static core::EightInts shrink(int size, const core::EightInts& levels) {
    const core::EightInts some = (core::EightInts{} + size) >> levels;
    return some > 1 ? some : core::EightInts{} + 1;
  }

  /// Whatever the coordinate is, the texels are the texture's.
  CATOPTRIC_INLINE static Taps findTaps(lanes::Float coordinate, const core::EightInts& size,
                                        lanes::Float centre, scene::Wrap wrap) {
    using namespace lanes;
    Float tamed = clamp(coordinate, -2.0f, 3.0f);
    if (wrap == scene::Wrap::Repeat) tamed = coordinate - floor(coordinate);
    if (wrap == scene::Wrap::MirroredRepeat) {
      tamed = coordinate - 2.0f * floor(coordinate * 0.5f);
      tamed = min(tamed, 2.0f - tamed);
    }
    const Float place = tamed * fromInts(size) - centre, left = floor(place);
    Taps taps{toInts(left), {}, size, place - left};
    taps.upper = taps.lower + 1;
    if (wrap == scene::Wrap::Repeat) {
      taps.lower = taps.lower < 0 ? taps.lower + size : taps.lower;
      taps.upper = taps.upper >= size ? taps.upper - size : taps.upper;
    }
    taps.lower = keepWithin(taps.lower, size);
    taps.upper = keepWithin(taps.upper, size);
    return taps;
  }

  CATOPTRIC_INLINE lanes::Vec4 fetch(const core::EightInts& at) const {
    using namespace lanes;
    core::EightInts texel;
    for (int i = 0; i < core::kLanes; ++i) texel[i] = std::int32_t(texels_[std::size_t(at[i])]);
    constexpr float kScale = 1.0f / 255.0f;
    Vec4 c(fromInts(texel & 255) * kScale, fromInts((texel >> 8) & 255) * kScale,
           fromInts((texel >> 16) & 255) * kScale, fromInts((texel >> 24) & 255) * kScale);
    if (isSrgb_) c = Vec4(linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z), c.w);
    return c;
  }

  std::vector<std::uint32_t> texels_;  ///< of all levels; red in the lowest byte
  std::array<std::int32_t, 32> offsets_{};
  int width_, height_, levels_;
  scene::Wrap wrapU_, wrapV_;
  bool magnifyNearest_, minifyNearest_, isSrgb_;
};

/// A latitude-longitude image of linear radiance. u wraps around, v is clamped.
struct LaneLatLong {
  const float* texels = nullptr;
  int width = 0, height = 0;
};

/// Eight texels, each from an image of its own and blended of four; uv.x from 0 to 1. `kFloats`: in a texel,
/// the first three count.
template <int kFloats>
CATOPTRIC_INLINE lanes::Vec3 sampleLatLong(const LaneLatLong* const (&images)[core::kLanes],
                                           const lanes::Vec2& uv) {
  using namespace lanes;
  using core::EightInts;
  using Four = float __attribute__((vector_size(16)));
  EightInts width, height;
  for (int i = 0; i < core::kLanes; ++i) width[i] = images[i]->width, height[i] = images[i]->height;
  const Float x = uv.x * fromInts(width) - 0.5f, y = uv.y * fromInts(height) - 0.5f;
  const Float left = floor(x), top = floor(y), right = x - left, below = y - top;
  EightInts x0 = toInts(left), x1 = x0 + 1;
  x0 = keepWithin(x0 < 0 ? width - 1 : x0, width);
  x1 = keepWithin(x1 >= width ? EightInts{} : x1, width);
  const EightInts y0 = keepWithin(toInts(top), height), y1 = keepWithin(toInts(top) + 1, height);
  const EightInts at[4] = {kFloats * (y0 * width + x0), kFloats * (y0 * width + x1),
                           kFloats * (y1 * width + x0), kFloats * (y1 * width + x1)};
  const Float share[4] = {(1.0f - right) * (1.0f - below), right * (1.0f - below), (1.0f - right) * below,
                          right * below};
  vec4 blended[core::kLanes];
  const vec4* rows[core::kLanes];
  for (int i = 0; i < core::kLanes; ++i) {
    Four sum{};
    for (int k = 0; k < 4; ++k) {
      const float* t = images[i]->texels + at[k][i];
      Four texel{t[0], t[1], t[2], 0.0f};
      if constexpr (kFloats == 4) std::memcpy(&texel, t, sizeof texel);
      sum += texel * share[k].v[i];
    }
    std::memcpy(&blended[i], &sum, sizeof sum);
    rows[i] = &blended[i];
  }
  return Vec3(loadRows(rows));
}

/// The environment where the processor shades.
class LaneEnvironment {
 public:
  /// `environment` must outlive the object.
  explicit LaneEnvironment(const scene::Environment& environment);

  [[nodiscard]] ivec2 size() const { return {levels_[0].width, levels_[0].height}; }
  [[nodiscard]] float lastLevel() const { return float(levels_.size() - 1); }
  [[nodiscard]] float lastLayer() const { return float(layers_.size() - 1); }

  /// Blends the two layers nearest to a roughness, 0 to 1, for findBlurred(); once.
  void addBlurred(float roughness);
  /// Null: it was not added, or there are too many.
  [[nodiscard]] const LaneLatLong* findBlurred(float roughness) const;

  /// GLSL's textureLod() at a whole level; beyond the last one, which lanes may ask for, that one.
  CATOPTRIC_INLINE lanes::Vec3 sampleLevel(const lanes::Vec2& uv, lanes::Float level) const {
    return sampleLatLong<3>(pick(levels_, level).images, uv);
  }
  /// The same with a layer of those blurred by roughness.
  CATOPTRIC_INLINE lanes::Vec3 sampleLayer(const lanes::Vec2& uv, lanes::Float layer) const {
    return sampleLatLong<4>(pick(layers_, layer).images, uv);
  }
  CATOPTRIC_INLINE static lanes::Vec3 sampleBlurred(const LaneLatLong& image, const lanes::Vec2& uv) {
    Picked all;
    for (const LaneLatLong*& one : all.images) one = &image;
    return sampleLatLong<4>(all.images, uv);
  }

 private:
  struct Picked {
    const LaneLatLong* images[core::kLanes];
  };
  CATOPTRIC_INLINE static Picked pick(const std::vector<LaneLatLong>& images, lanes::Float number) {
    const core::EightInts which = keepWithin(lanes::toInts(number), core::EightInts{} + int(images.size()));
    Picked picked;
    for (int i = 0; i < core::kLanes; ++i) picked.images[i] = &images[std::size_t(which[i])];
    return picked;
  }

  struct Blurred {
    float roughness;
    std::vector<vec4> texels;
    LaneLatLong image;
  };
  std::vector<LaneLatLong> levels_, layers_;
  std::vector<std::vector<vec4>> layerTexels_;
  std::vector<Blurred> blurred_;
};

}  // namespace catoptric::raster
