// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/noise.h"

#include <cmath>

namespace catoptric::scene::built_in {
namespace {

int wrap(int i, int period) {
  return ((i % period) + period) % period;
}

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace

double hashToUnit(int x, int y, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9E3779B9u ^ std::uint32_t(x) * 0x85EBCA6Bu ^ std::uint32_t(y) * 0xC2B2AE35u;
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  h ^= h >> 16;
  return double(h) / 4294967296.0;
}

double periodicNoise(const dvec2& p, const ivec2& period, std::uint32_t seed) {
  const dvec2 cell = glm::floor(p);
  const double fx = fade(p.x - cell.x), fy = fade(p.y - cell.y);
  const int x0 = wrap(int(cell.x), period.x), x1 = wrap(x0 + 1, period.x);
  const int y0 = wrap(int(cell.y), period.y), y1 = wrap(y0 + 1, period.y);
  const double top = glm::mix(hashToUnit(x0, y0, seed), hashToUnit(x1, y0, seed), fx);
  const double bottom = glm::mix(hashToUnit(x0, y1, seed), hashToUnit(x1, y1, seed), fx);
  return glm::mix(top, bottom, fy);
}

double fractalNoise(const dvec2& p, const ivec2& period, int octaves, std::uint32_t seed) {
  double sum = 0, weight = 0, strength = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    const int scale = 1 << octave;
    sum += strength * periodicNoise(p * double(scale), period * scale, seed + std::uint32_t(octave) * 101u);
    weight += strength;
    strength *= 0.5;
  }
  return sum / weight;
}

}  // namespace catoptric::scene::built_in
