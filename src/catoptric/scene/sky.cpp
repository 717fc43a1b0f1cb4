// SPDX-License-Identifier: Apache-2.0
// What does the sky look like in each direction?
//
// Input: a unit direction d, y up. Output: linear radiance, for pictures at exposure 1: a white matte floor
// under it reflects about 0.8 (a little more in blue).
//
// 1. Air: from a bright horizon to a blue zenith, exponential in height.
// 2. Sun: a soft disc of 2 degrees and two exponential glows around it. Its peak is moderate (55), because a
//    rasterizer without bloom shows a real sun (10^9) as nothing but aliasing.
// 3. Clouds: fractal gradient noise on a flat ceiling, which perspective makes smaller towards the horizon.
//    It is a function of the direction, so the map has no seam at u = 0. Octaves that fall below two texels
//    are faded out. Where the noise grows towards the sun, the cloud lies in its own shade.
// 4. Ground: a warm grey that darkens towards the nadir, joined to the air by haze, so that the horizon in a
//    chrome ball is a soft line.
//
// No physics: Preetham's or Hosek's model is truer, but its horizon at this exposure is white and its ground
// black. Cost: 2048x1024 in about 0.1 s on two cores. Noise after Perlin, "Improving Noise", 2002, in two
// dimensions.
#include "catoptric/scene/sky.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "catoptric/core/parallel.h"

namespace catoptric::scene {
namespace {

constexpr vec3 kHorizon{0.98f, 1.01f, 1.05f};
constexpr vec3 kZenith{0.21f, 0.40f, 0.76f};
constexpr vec3 kSunColour{1.00f, 0.90f, 0.74f};
constexpr float kSunPeak = 55.0f;
constexpr vec3 kCloudLit{1.95f, 1.86f, 1.71f};
constexpr vec3 kCloudShade{0.80f, 0.82f, 0.86f};
constexpr vec3 kGroundNear{0.46f, 0.43f, 0.39f};
constexpr vec3 kGroundNadir{0.20f, 0.19f, 0.18f};

float smoothStep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Dot product of the offset with one of eight gradients, chosen by a multiplicative hash of the lattice
/// point.
float gradientDot(int latticeX, int latticeY, float x, float y) {
  static constexpr float kGradients[8][2] = {{1, 0},
                                             {-1, 0},
                                             {0, 1},
                                             {0, -1},
                                             {0.707f, 0.707f},
                                             {-0.707f, 0.707f},
                                             {0.707f, -0.707f},
                                             {-0.707f, -0.707f}};
  std::uint32_t hash = std::uint32_t(latticeX) * 0x9E3779B1u ^ std::uint32_t(latticeY) * 0x85EBCA77u;
  hash = (hash ^ (hash >> 15)) * 0x846CA68Bu;
  const float* g = kGradients[hash >> 29];
  return g[0] * x + g[1] * y;
}

/// std::floor is a function call on the oldest processors that we build for.
int floorToInt(float x) {
  const int truncated = int(x);
  return float(truncated) > x ? truncated - 1 : truncated;
}

/// Gradient noise, about -0.7..0.7.
float noise(float x, float y) {
  const int ix = floorToInt(x), iy = floorToInt(y);
  x -= float(ix);
  y -= float(iy);
  const float wx = x * x * x * (x * (x * 6.0f - 15.0f) + 10.0f),
              wy = y * y * y * (y * (y * 6.0f - 15.0f) + 10.0f);
  const float top = glm::mix(gradientDot(ix, iy, x, y), gradientDot(ix + 1, iy, x - 1.0f, y), wx);
  const float bottom =
      glm::mix(gradientDot(ix, iy + 1, x, y - 1.0f), gradientDot(ix + 1, iy + 1, x - 1.0f, y - 1.0f), wx);
  return glm::mix(top, bottom, wy);
}

/// `footprint` is the distance between neighbouring texels on the ceiling.
float fractalNoise(float x, float y, int octaves, float footprint) {
  float sum = 0.0f, amplitude = 1.0f, frequency = 1.0f;
  for (int i = 0; i < octaves; ++i) {
    const float visible = std::clamp(2.0f - 4.0f * frequency * footprint, 0.0f, 1.0f);
    if (visible <= 0.0f) break;
    sum += amplitude * visible * noise(x * frequency + 17.3f * float(i), y * frequency - 9.1f * float(i));
    amplitude *= 0.5f;
    frequency *= 2.03f;
  }
  return sum;
}

/// Step 1.
vec3 airRadiance(float height) {
  return glm::mix(kZenith, kHorizon, std::exp(-2.8f * height));
}

/// Step 2.
vec3 sunRadiance(float cosToSun) {
  const float away = 1.0f - cosToSun;
  const float disc = kSunPeak * (1.0f - smoothStep(0.0003f, 0.0010f, away));  // 1.4 to 2.6 degrees
  return kSunColour * (disc + 3.5f * std::exp(-220.0f * away) + 0.55f * std::exp(-7.0f * away));
}

/// Step 3: lays the clouds over `behind`. `radiansPerTexel` sets the smallest detail.
vec3 coverByClouds(const vec3& behind, const vec3& d, const vec3& toSun, float cosToSun,
                   float radiansPerTexel) {
  constexpr float kCeilingBend = 0.14f;  // keeps the horizon finitely far away
  constexpr float kScale = 1.3f;
  const float fade = smoothStep(0.01f, 0.22f, d.y);
  if (fade <= 0.0f) return behind;
  const float bent = d.y + kCeilingBend;
  const float x = kScale * d.x / bent, y = kScale * d.z / bent;
  const float footprint = radiansPerTexel * kScale / (bent * bent);
  const float here = fractalNoise(x, y, 6, footprint);
  const float cover = smoothStep(-0.06f, 0.56f, here) * fade;
  if (cover <= 0.0f) return behind;
  const float towardsSun = fractalNoise(x + 0.16f * toSun.x, y + 0.16f * toSun.z, 4, footprint);
  const float lit = std::clamp(0.62f + 1.1f * (here - towardsSun) - 0.45f * cover, 0.0f, 1.0f);
  const float silverLining = 0.9f * std::exp(-18.0f * (1.0f - cosToSun));
  const vec3 cloud = glm::mix(kCloudShade, kCloudLit, lit) + kSunColour * silverLining;
  return glm::mix(behind, cloud, 0.92f * cover);
}

/// Step 4, for y below 0.
vec3 groundRadiance(float y) {
  const vec3 ground = glm::mix(kGroundNadir, kGroundNear, std::exp(2.2f * y));
  return glm::mix(ground, kHorizon * 0.80f, std::exp(y / 0.025f));
}

/// What all directions of one height have in common.
struct SkyRow {
  vec3 air;
  float sunFade, haze;
};

SkyRow makeSkyRow(float height) {
  return {airRadiance(height), smoothStep(0.0f, 0.05f, height), std::exp(-height / 0.02f)};
}

/// Of a direction that does not go down.
vec3 skyRadiance(const vec3& d, const SkyRow& row, const vec3& toSun, float radiansPerTexel) {
  const float cosToSun = glm::dot(d, toSun);
  const vec3 clear = row.air + sunRadiance(cosToSun) * row.sunFade;
  const vec3 horizonHaze = kHorizon * 0.80f;
  return glm::mix(coverByClouds(clear, d, toSun, cosToSun, radiansPerTexel), horizonHaze, row.haze);
}

}  // namespace

dvec3 skySunDirection() {
  return glm::normalize(dvec3(0.55, 0.75, 0.50));
}

core::ImageRgbF makeSkyImage(int widthPx, int heightPx) {
  core::ImageRgbF image(widthPx, heightPx);
  std::vector<vec2> azimuths(std::size_t(widthPx), vec2(0));  // sine and cosine
  for (std::size_t x = 0; x < azimuths.size(); ++x) {
    const double phi = 2.0 * glm::pi<double>() * ((double(x) + 0.5) / widthPx - 0.5);
    azimuths[x] = vec2(std::sin(phi), std::cos(phi));
  }
  const vec3 toSun(skySunDirection());
  const float radiansPerTexel = glm::pi<float>() / float(heightPx);
  core::parallelFor(std::size_t(heightPx), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const double theta = glm::pi<double>() * (double(y) + 0.5) / heightPx;
      const float sine = float(std::sin(theta)), cosine = float(std::cos(theta));
      vec3* row = &image.at(0, int(y));
      if (cosine < 0.0f) {
        std::fill_n(row, azimuths.size(), groundRadiance(cosine));
        continue;
      }
      const SkyRow common = makeSkyRow(cosine);
      for (std::size_t x = 0; x < azimuths.size(); ++x)
        row[x] = skyRadiance(vec3(sine * azimuths[x].x, cosine, -sine * azimuths[x].y), common, toSun,
                             radiansPerTexel);
    }
  });
  return image;
}

}  // namespace catoptric::scene
