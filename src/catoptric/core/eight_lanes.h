// SPDX-License-Identifier: Apache-2.0
// Eight numbers side by side, for loops that core/widest_vectors.h compiles for several processors.
//
// src/catoptric/CMakeLists.txt gives flags to the files that include it: without them a root of eight lanes
// is not one instruction.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "catoptric/core/widest_vectors.h"

// How vectors are handed over by value does not matter: all is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace catoptric::core {

inline constexpr int kLanes = 8;

using Eight = float __attribute__((vector_size(32)));
/// Also truths: -1 where something holds, 0 where not.
using EightInts = std::int32_t __attribute__((vector_size(32)));
using Eights = Eight[8];

CATOPTRIC_INLINE Eight load(const float* from) {
  Eight value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

CATOPTRIC_INLINE void store(float* to, const Eight& value) {
  std::memcpy(to, &value, sizeof value);
}

CATOPTRIC_INLINE Eight dot(const Eight* a, const Eight* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

CATOPTRIC_INLINE Eight squareRoot(const Eight& a) {
  Eight root = a;
  for (int i = 0; i < kLanes; ++i) root[i] = std::sqrt(root[i]);
  return root;
}

CATOPTRIC_INLINE Eight larger(const Eight& a, const Eight& b) {
  return a > b ? a : b;
}

CATOPTRIC_INLINE Eight smaller(const Eight& a, const Eight& b) {
  return a < b ? a : b;
}

/// A bit for each lane that holds.
CATOPTRIC_INLINE unsigned toBits(const EightInts& holds) {
  EightInts bits = holds & EightInts{1, 2, 4, 8, 16, 32, 64, 128};
  bits |= __builtin_shufflevector(bits, bits, 4, 5, 6, 7, 0, 1, 2, 3);
  bits |= __builtin_shufflevector(bits, bits, 2, 3, 0, 1, 6, 7, 4, 5);
  bits |= __builtin_shufflevector(bits, bits, 1, 0, 3, 2, 5, 4, 7, 6);
  return unsigned(bits[0]);
}

/// The other way round.
CATOPTRIC_INLINE EightInts fromBits(unsigned bits) {
  return ((EightInts{} + std::int32_t(bits)) & EightInts{1, 2, 4, 8, 16, 32, 64, 128}) != 0;
}

/// Rows become columns.
CATOPTRIC_INLINE void transpose(Eights& m) {
  Eights pairs, fours;
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = __builtin_shufflevector(m[k], m[k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[k + 1] = __builtin_shufflevector(m[k], m[k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int k = 0; k < 8; k += 4)
    for (int h = 0; h < 2; ++h) {
      fours[k + 2 * h] = __builtin_shufflevector(pairs[k + h], pairs[k + h + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      fours[k + 2 * h + 1] =
          __builtin_shufflevector(pairs[k + h], pairs[k + h + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int k = 0; k < 4; ++k) {
    m[k] = __builtin_shufflevector(fours[k], fours[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    m[k + 4] = __builtin_shufflevector(fours[k], fours[k + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Points of an array of triples as three columns: from[which[0]], from[which[step]] and so on.
CATOPTRIC_INLINE void gatherTriples(const float* from, const std::uint32_t* which, int step, Eight* columns) {
  using Two = double __attribute__((vector_size(16)));
  using Four = float __attribute__((vector_size(16)));
  Four rows[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const float* triple = from + 3 * std::size_t(which[i * step]);
    Two both{};  // not one float more than there is
    std::memcpy(&both, triple, 2 * sizeof(float));
    std::memcpy(&rows[i], &both, sizeof both);
    rows[i][2] = triple[2];
  }
  Eight r[4], pairs[4];
  for (int i = 0; i < 4; ++i) r[i] = __builtin_shufflevector(rows[i], rows[i + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  for (int i = 0; i < 2; ++i) {
    pairs[2 * i] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[2 * i + 1] = __builtin_shufflevector(r[2 * i], r[2 * i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  columns[0] = __builtin_shufflevector(pairs[0], pairs[2], 0, 1, 8, 9, 4, 5, 12, 13);
  columns[1] = __builtin_shufflevector(pairs[0], pairs[2], 2, 3, 10, 11, 6, 7, 14, 15);
  columns[2] = __builtin_shufflevector(pairs[1], pairs[3], 0, 1, 8, 9, 4, 5, 12, 13);
}

}  // namespace catoptric::core
