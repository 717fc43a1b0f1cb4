// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/noise.h"

#include <algorithm>

#include "catoptric/core/widest_vectors.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // all vectors are inlined

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
constexpr std::uint32_t kOctaveSeed = 101;

constexpr int kLanes = 4;
using Doubles = double __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(16)));
using Words = std::uint32_t __attribute__((vector_size(16)));
using WordPairs = std::uint32_t __attribute__((vector_size(32)));

CATOPTRIC_INLINE Doubles toDoubles(const Words& words) {
  constexpr std::uint32_t kSign = 1u << 31;  // only signed numbers are converted by one instruction
  return __builtin_convertvector(Ints(words ^ kSign), Doubles) + double(kSign);
}

/// hash() at two lattice points in each octave, of which the parts of x and y are given.
CATOPTRIC_INLINE void hashValues(const WordPairs& xPart, const Words& yPart, Doubles& left, Doubles& right) {
  WordPairs h = xPart ^ __builtin_shufflevector(yPart, yPart, 0, 1, 2, 3, 4, 5, 6, 7);
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  h ^= h >> 16;
  left = toDoubles(__builtin_shufflevector(h, h, 0, 1, 2, 3));
  right = toDoubles(__builtin_shufflevector(h, h, 4, 5, 6, 7));
}

/// periodicNoise() of four octaves from `first` on, to the bit, each half as strong as the one before; those
/// from `octaves` on are nothing. Added to `sum` in order.
struct FourOctaves {
  CATOPTRIC_INLINE static void run(const dvec2& p, const ivec2& period, const int& first, const int& octaves,
                                   const std::uint32_t& seed, double& sum) {
    const Ints scales = Ints{1, 2, 4, 8} << first;
    const Words numbers = Words{0, 1, 2, 3} + std::uint32_t(first);
    const Doubles scale = __builtin_convertvector(scales, Doubles);
    const Words seedPart = (seed + numbers * kOctaveSeed) * 0x9E3779B9u;
    Doubles fraction[2];
    Words low[2], high[2];
    for (int axis = 0; axis < 2; ++axis) {
      const Doubles x = p[axis] * scale;
      const Ints truncated = __builtin_convertvector(x, Ints), repeat = period[axis] * scales;
      const Ints isAbove = __builtin_convertvector(__builtin_convertvector(truncated, Doubles) > x, Ints);
      const Ints cell = truncated + isAbove;  // -1 where it holds
      const Doubles t = x - __builtin_convertvector(cell, Doubles);
      fraction[axis] = t * t * t * (t * (t * 6 - 15) + 10);
      Ints at = cell;
      const Ints isOutside = (cell < 0) | (cell >= repeat);
      if ((isOutside[0] | isOutside[1] | isOutside[2] | isOutside[3]) != 0)
        for (int lane = 0; lane < kLanes; ++lane) at[lane] = wrap(cell[lane], repeat[lane]);
      const Ints following = at + 1;
      const std::uint32_t factor = axis == 0 ? 0x85EBCA6Bu : 0xC2B2AE35u;
      low[axis] = Words(at) * factor;
      high[axis] = Words(following == repeat ? Ints{} : following) * factor;
    }
    const WordPairs xPart =
        __builtin_shufflevector(low[0] ^ seedPart, high[0] ^ seedPart, 0, 1, 2, 3, 4, 5, 6, 7);
    Doubles a, b, c, d;
    hashValues(xPart, low[1], a, b);
    hashValues(xPart, high[1], c, d);
    const Doubles top = a + (b - a) * fraction[0], bottom = c + (d - c) * fraction[0];
    const Doubles noise = (top + (bottom - top) * fraction[1]) * kToUnit;
    const Doubles weighted = noise * (Doubles{1, 0.5, 0.25, 0.125} * (1.0 / double(1 << first)));  // exact
    const int count = std::min(octaves - first, kLanes);
    for (int lane = 0; lane < count; ++lane) sum += weighted[lane];
  }
};

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
  double sum = 0;
  for (int first = 0; first < octaves; first += kLanes)
    core::runOnWidestVectors<FourOctaves>(p, period, first, octaves, seed, sum);
  return sum / (2.0 - 2.0 / double(1 << octaves));  // by 1 + 1/2 + 1/4 + ...
}

}  // namespace catoptric::scene::built_in
