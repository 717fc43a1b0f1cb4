// SPDX-License-Identifier: Apache-2.0
// What does a rough surface see of the environment, and what does a matte one?
//
// Input: the mip chain of a latitude-longitude map, linear radiance.
// Rough: for roughness r = i / (N-1), alpha = r^2, and each direction n of a 128x64 map, the mean of
// radiance(l) over the GGX lobe of a surface with normal n, seen from n, weighted by dot(n, l).
// 1. Directions are drawn from the distribution of normals (Hammersley points): h, then l = 2 (n.h) h - n.
// 2. Each sample stands for the solid angle 1 / (count * density); it reads the mip level whose texels are
//    about that large, so a few hundred give a smooth result even around the sun. Never a level finer than
//    the result.
// 3. The map and the lobe look the same from every column of a row: samples are turned into map coordinates
//    once per row, and each column adds its own u. This saves all arc functions and makes the cost that of
//    the look-ups.
// Matte: irradiance / pi in nine spherical harmonics. Radiance is projected, and the bands 0, 1, 2 are
// multiplied by the cosine lobe's 1, 2/3 and 1/4 (pi, 2pi/3, pi/4 over pi).
//
// Departures: viewing direction = normal (Karis), so highlights at grazing angles do not stretch.
// Failures: nine coefficients ring around a small strong light by some per cent and may go below zero
// opposite to it, where evaluateIrradiance() stops at 0. Cost: about 70 ms on two cores, whatever the size of
// the map. Source: Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course; Krivanek & Colbert,
// "Real-time Shading with Filtered Importance Sampling", EGSR 2008; Ramamoorthi & Hanrahan, "An Efficient
// Representation for Irradiance Environment Maps", SIGGRAPH 2001.
#include "catoptric/scene/environment_prefilter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "catoptric/core/parallel.h"

namespace catoptric::scene {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A direction of the lobe around n = +z of the tangent frame.
struct LobeSample {
  dvec3 direction{0};
  double weight = 0;
  int mip = 0;
};

/// The same in texels of its mip level, for one row of the result: what all columns share of a bilinear
/// look-up.
struct RowSample {
  const vec3 *top = nullptr, *bottom = nullptr;  // rows of the level
  float weightTop = 0, weightBottom = 0;
  float x = 0;  // of the left texel for u = 0, in 0..width
  int width = 0;
};

double radicalInverse(std::uint32_t i) {
  i = (i << 16) | (i >> 16);
  i = ((i & 0x00ff00ffu) << 8) | ((i & 0xff00ff00u) >> 8);
  i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
  i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
  i = ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
  return double(i) / 4294967296.0;
}

/// The finest level that is no finer than `width`, or the one above where sizes do not match.
int findMip(std::span<const core::ImageRgbF> mips, int width) {
  int level = 0;
  while (level + 1 < int(mips.size()) && mips[std::size_t(level) + 1].width() >= width) ++level;
  return level;
}

/// Steps 1 and 2.
std::vector<LobeSample> makeLobe(double roughness, std::uint32_t count,
                                 std::span<const core::ImageRgbF> mips) {
  constexpr int kCoarsestWidth = 32;
  constexpr double kMipBias = 1.0;  // samples overlap, so that their pattern does not show (Colbert)
  const int finest = findMip(mips, kPrefilteredWidth), coarsest = findMip(mips, kCoarsestWidth);
  const double alpha2 = std::pow(roughness, 4.0);
  const double texelSolidAngle = (2.0 * kPi / mips[0].width()) * (kPi / mips[0].height());
  std::vector<LobeSample> lobe;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double a = (i + 0.5) / count, phi = 2.0 * kPi * radicalInverse(i);
    const double cos2 = (1.0 - a) / (1.0 + (alpha2 - 1.0) * a), cosH = std::sqrt(cos2);
    const double sinH = std::sqrt(1.0 - cos2);
    const dvec3 h(sinH * std::cos(phi), sinH * std::sin(phi), cosH);
    const dvec3 l = 2.0 * cosH * h - dvec3(0, 0, 1);
    if (l.z <= 0.0) continue;
    const double d = cos2 * (alpha2 - 1.0) + 1.0;
    const double density = alpha2 / (kPi * d * d) / 4.0;  // D n.h / (4 v.h), v = n
    const double level = 0.5 * std::log2(1.0 / (count * density * texelSolidAngle)) + kMipBias;
    lobe.push_back({l, l.z, std::clamp(int(std::lround(level)), finest, coarsest)});
  }
  double sum = 0;
  for (const LobeSample& sample : lobe) sum += sample.weight;
  for (LobeSample& sample : lobe) sample.weight /= sum;
  return lobe;
}

/// Step 3: the lobe around the direction of column u = 0.5 of the row at v.
std::vector<RowSample> turnToRow(std::span<const LobeSample> lobe, double v,
                                 std::span<const core::ImageRgbF> mips) {
  const dvec3 n = directionFromLatLong(0.5, v), side(1, 0, 0), up = glm::cross(n, side);
  std::vector<RowSample> row;
  row.reserve(lobe.size());
  for (const LobeSample& sample : lobe) {
    const core::ImageRgbF& map = mips[std::size_t(sample.mip)];
    const dvec3 d = sample.direction.x * side + sample.direction.y * up + sample.direction.z * n;
    const double du = std::atan2(d.x, -d.z) / (2.0 * kPi);
    const double x = du * map.width() - 0.5;
    const double y =
        std::clamp(std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi * map.height() - 0.5, 0.0, map.height() - 1.0);
    const int top = int(y), bottom = std::min(top + 1, map.height() - 1);
    row.push_back({&map.at(0, top), &map.at(0, bottom), float(sample.weight * (1.0 - (y - top))),
                   float(sample.weight * (y - top)), float(x - std::floor(x / map.width()) * map.width()),
                   map.width()});
  }
  return row;
}

/// sampleLatLong() of all samples at once, for the column at u.
vec3 sumSamples(std::span<const RowSample> samples, float u) {
  vec3 sum(0);
  for (const RowSample& sample : samples) {
    const float x = u * float(sample.width) + sample.x;
    const int xi = int(x);
    int left = xi;
    while (left >= sample.width) left -= sample.width;  // once, or twice by rounding
    const int right = left + 1 < sample.width ? left + 1 : 0;
    const float f = x - float(xi);
    sum += (sample.top[left] * (1.0f - f) + sample.top[right] * f) * sample.weightTop;
    sum += (sample.bottom[left] * (1.0f - f) + sample.bottom[right] * f) * sample.weightBottom;
  }
  return sum;
}

core::ImageRgbF resizeMap(const core::ImageRgbF& source) {
  core::ImageRgbF result(kPrefilteredWidth, kPrefilteredHeight);
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x)
      result.at(x, y) = sampleLatLong(source, (float(x) + 0.5f) / kPrefilteredWidth,
                                      (float(y) + 0.5f) / kPrefilteredHeight);
  return result;
}

core::ImageRgbF blurMap(double roughness, std::span<const core::ImageRgbF> mips) {
  // Step 4.
  const bool isWide = roughness > 0.5;
  const int width = isWide ? kPrefilteredWidth / 2 : kPrefilteredWidth;
  const int height = isWide ? kPrefilteredHeight / 2 : kPrefilteredHeight;
  const std::vector<LobeSample> lobe = makeLobe(roughness, isWide ? 1024 : 256, mips);
  core::ImageRgbF result(width, height);
  core::parallelFor(std::size_t(height), 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const std::vector<RowSample> samples = turnToRow(lobe, (double(y) + 0.5) / height, mips);
      for (int x = 0; x < width; ++x)
        result.at(x, int(y)) = sumSamples(samples, (float(x) + 0.5f) / float(width));
    }
  });
  return isWide ? resizeMap(result) : result;
}

}  // namespace

dvec3 directionFromLatLong(double u, double v) {
  const double phi = 2.0 * kPi * (u - 0.5), theta = kPi * v;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

vec3 sampleLatLong(const core::ImageRgbF& map, float u, float v) {
  const float x = (u - std::floor(u)) * float(map.width()) - 0.5f;
  const float y = std::clamp(v * float(map.height()) - 0.5f, 0.0f, float(map.height() - 1));
  const int xi = int(x + 1.0f) - 1, y0 = int(y);  // floor: x is at least -0.5
  const int x0 = xi < 0 ? map.width() - 1 : xi, x1 = x0 + 1 < map.width() ? x0 + 1 : 0;
  const int y1 = std::min(y0 + 1, map.height() - 1);
  const float fx = x - float(xi), fy = y - float(y0);
  const vec3 top = glm::mix(map.at(x0, y0), map.at(x1, y0), fx);
  const vec3 bottom = glm::mix(map.at(x0, y1), map.at(x1, y1), fx);
  return glm::mix(top, bottom, fy);
}

std::vector<core::ImageRgbF> prefilterEnvironment(std::span<const core::ImageRgbF> mips, int levels) {
  std::vector<core::ImageRgbF> result;
  result.push_back(resizeMap(mips[std::size_t(findMip(mips, kPrefilteredWidth))]));
  for (int i = 1; i < levels; ++i) result.push_back(blurMap(double(i) / (levels - 1), mips));
  return result;
}

std::array<vec3, 9> projectIrradiance(std::span<const core::ImageRgbF> mips) {
  constexpr int kWidth = 256, kHeight = 128;
  const core::ImageRgbF& map = mips[std::size_t(findMip(mips, kWidth))];
  std::array<dvec3, 9> sum{};
  for (int y = 0; y < kHeight; ++y) {
    // The exact solid angle of the row's cells; their sum is 4 pi.
    const double solidAngle =
        (std::cos(kPi * y / kHeight) - std::cos(kPi * (y + 1) / kHeight)) * 2.0 * kPi / kWidth;
    for (int x = 0; x < kWidth; ++x) {
      const double u = (x + 0.5) / kWidth, v = (y + 0.5) / kHeight;
      const dvec3 d = directionFromLatLong(u, v);
      const double basis[9] = {0.282095,
                               0.488603 * d.y,
                               0.488603 * d.z,
                               0.488603 * d.x,
                               1.092548 * d.x * d.y,
                               1.092548 * d.y * d.z,
                               0.315392 * (3.0 * d.z * d.z - 1.0),
                               1.092548 * d.x * d.z,
                               0.546274 * (d.x * d.x - d.y * d.y)};
      const dvec3 light = dvec3(sampleLatLong(map, float(u), float(v))) * solidAngle;
      for (std::size_t i = 0; i < 9; ++i) sum[i] += light * basis[i];
    }
  }
  std::array<vec3, 9> result{};
  for (std::size_t i = 0; i < 9; ++i) result[i] = vec3(sum[i] * (i == 0 ? 1.0 : i < 4 ? 2.0 / 3.0 : 0.25));
  return result;
}

}  // namespace catoptric::scene
