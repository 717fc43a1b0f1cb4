// SPDX-License-Identifier: Apache-2.0
// Smooth noise that repeats, from integer hashes: the same on every machine.
#pragma once

#include <cstdint>

#include "catoptric/core/math.h"

namespace catoptric::scene::built_in {

/// Uniform in [0, 1).
[[nodiscard]] double hashToUnit(int x, int y, std::uint32_t seed);

/// Value noise in [0, 1] with one lattice point per unit; repeats after `period` units in x and y.
[[nodiscard]] double periodicNoise(const dvec2& p, const ivec2& period, std::uint32_t seed);

/// Sum of octaves, each half as strong and twice as fine, in [0, 1]; repeats after `period`.
[[nodiscard]] double fractalNoise(const dvec2& p, const ivec2& period, int octaves, std::uint32_t seed);

}  // namespace catoptric::scene::built_in
