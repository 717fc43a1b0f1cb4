// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/noise.h"

namespace catoptric::scene::built_in {
namespace {

int wrap(int i, int period) {
  if (unsigned(i) < unsigned(period)) return i;  // nearly always: saves a division
  const int rest = i % period;
  return rest < 0 ? rest + period : rest;
}

int next(int i, int period) {
  return i + 1 == period ? 0 : i + 1;
}

/// std::floor is a function call on the oldest processors that we build for.
int floorToInt(double x) {
  const int truncated = int(x);
  return truncated > x ? truncated - 1 : truncated;
}

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

inline std::uint32_t hash(int x, int y, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9E3779B9u ^ std::uint32_t(x) * 0x85EBCA6Bu ^ std::uint32_t(y) * 0xC2B2AE35u;
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  return h ^ (h >> 16);
}

constexpr double kToUnit = 1.0 / 4294967296.0;

}  // namespace

double hashToUnit(int x, int y, std::uint32_t seed) {
  return hash(x, y, seed) * kToUnit;
}

double periodicNoise(const dvec2& p, const ivec2& period, std::uint32_t seed) {
  const int cellX = floorToInt(p.x), cellY = floorToInt(p.y);
  const double fx = fade(p.x - cellX), fy = fade(p.y - cellY);
  const int x0 = wrap(cellX, period.x), x1 = next(x0, period.x);
  const int y0 = wrap(cellY, period.y), y1 = next(y0, period.y);
  const double a = hash(x0, y0, seed), b = hash(x1, y0, seed), c = hash(x0, y1, seed), d = hash(x1, y1, seed);
  const double top = a + (b - a) * fx, bottom = c + (d - c) * fx;
  return (top + (bottom - top) * fy) * kToUnit;
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
