// SPDX-License-Identifier: Apache-2.0
// Textures and surroundings for eight pixels at once against what the ray tracer reads, one by one.
#include "catoptric/raster/lane_textures.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "catoptric/reference/texture_sampling.h"
#include "catoptric/scene/shading.h"
#include "catoptric/scene/texture_mips.h"

namespace catoptric::raster {
namespace {

using core::kLanes;

scene::Texture makeTexture(int width, int height) {
  std::mt19937 random(7);
  scene::Texture texture;
  texture.image = core::ImageRgba8(width, height);
  for (auto& texel : texture.image.pixels())
    texel = glm::u8vec4(random() & 255u, random() & 255u, random() & 255u, random() & 255u);
  return texture;
}

/// Largest difference between the two, at whole levels.
float findDifference(const scene::Texture& texture, bool isSrgb) {
  const std::vector<core::ImageRgba8> levels = scene::makeMipChain(texture.image, isSrgb);
  const LaneTexture lanes(texture, levels, isSrgb);
  const reference::SampledTexture judge(texture, isSrgb);
  const vec2 size(lanes.size());
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1.7f, 2.6f);
  float most = 0;
  for (int k = 0; k < 400; ++k) {
    lanes::Vec2 uv;
    lanes::Float level;
    for (int i = 0; i < kLanes; ++i) {
      uv.x.v[i] = place(random), uv.y.v[i] = place(random);
      level.v[i] = float(random() % levels.size());
    }
    const lanes::Vec4 read = lanes.sample(uv, level);
    for (int i = 0; i < kLanes; ++i) {
      const float texels = std::exp2(level.v[i]);  // a pixel covers so many
      const vec2 change(texels / size.x, 0);
      const vec4 expected = judge.sample({uv.x.v[i], uv.y.v[i]}, {change, vec2(0)});
      for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(read[c].v[i] - expected[c]));
    }
  }
  return most;
}

TEST(LaneTextures, areReadAsTheRayTracerReadsThem) {
  scene::Texture texture = makeTexture(24, 9);
  for (const scene::Wrap wrap : {scene::Wrap::Repeat, scene::Wrap::MirroredRepeat, scene::Wrap::ClampToEdge})
    for (const bool isSrgb : {false, true}) {
      texture.wrapU = wrap;
      texture.wrapV = scene::Wrap::Repeat;
      EXPECT_LT(findDifference(texture, isSrgb), 1e-4f) << int(wrap) << isSrgb;
      std::swap(texture.wrapU, texture.wrapV);
      EXPECT_LT(findDifference(texture, isSrgb), 1e-4f) << int(wrap) << isSrgb;
    }
}

TEST(LaneTextures, nearestTexelsAreKept) {
  scene::Texture texture = makeTexture(8, 8);
  texture.magnifyNearest = true;
  EXPECT_LT(findDifference(texture, false), 1e-6f);
  texture.minifyNearest = true;
  EXPECT_LT(findDifference(texture, true), 1e-4f);
}

TEST(LaneTextures, noCoordinateLeavesThem) {
  const scene::Texture texture = makeTexture(5, 3);
  const LaneTexture lanes(texture, scene::makeMipChain(texture.image, false), false);
  const scene::Environment sky = scene::makeConstantEnvironment(vec3(0.25f));
  const LaneEnvironment environment(sky);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0e30f, 3.0e9f}) {
    const lanes::Vec4 read = lanes.sample({bad, bad}, bad);
    const lanes::Vec3 light = environment.sampleLevel({bad, bad}, bad);
    static_cast<void>(read);  // a sanitizer sees where it was read
    static_cast<void>(light);
  }
}

TEST(LaneTextures, surroundingsAreReadAsTheRayTracerReadsThem) {
  const scene::Environment sky = scene::makeSkyEnvironment();
  LaneEnvironment environment(sky);
  environment.addBlurred(0.37f);
  std::mt19937 random(5);
  std::normal_distribution<float> side;
  const float last = environment.lastLayer(), layer = 0.37f * last, lower = std::floor(layer);
  for (int k = 0; k < 200; ++k) {
    lanes::Vec3 d;
    for (int i = 0; i < kLanes; ++i) {
      const vec3 one = glm::normalize(vec3(side(random), side(random), side(random)));
      d.x.v[i] = one.x, d.y.v[i] = one.y, d.z.v[i] = one.z;
    }
    lanes::Vec2 uv;
    for (int i = 0; i < kLanes; ++i) {
      const vec2 one = scene::glsl::latLongFromDirection({d.x.v[i], d.y.v[i], d.z.v[i]});
      uv.x.v[i] = one.x, uv.y.v[i] = one.y;
    }
    const lanes::Vec3 sharp = environment.sampleLevel(uv, 0.0f);
    const lanes::Vec3 blurred = LaneEnvironment::sampleBlurred(*environment.findBlurred(0.37f), uv);
    const lanes::Vec3 mixed = lanes::mix(environment.sampleLayer(uv, lower),
                                         environment.sampleLayer(uv, lower + 1.0f), layer - lower);
    for (int i = 0; i < kLanes; ++i) {
      const vec3 one(d.x.v[i], d.y.v[i], d.z.v[i]);
      const vec3 judge = reference::sampleEnvironment(sky, one, {});
      const vec3 judgeBlurred = reference::samplePrefiltered(sky, one, 0.37f);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sharp[c].v[i], judge[c], 1e-4f * std::max(judge[c], 1.0f));
        EXPECT_NEAR(blurred[c].v[i], judgeBlurred[c], 1e-4f * std::max(judgeBlurred[c], 1.0f));
        EXPECT_NEAR(mixed[c].v[i], judgeBlurred[c], 1e-4f * std::max(judgeBlurred[c], 1.0f));
      }
    }
  }
  EXPECT_EQ(environment.findBlurred(0.36f), nullptr);
}

}  // namespace
}  // namespace catoptric::raster
