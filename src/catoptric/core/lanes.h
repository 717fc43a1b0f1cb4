// SPDX-License-Identifier: Apache-2.0
// GLSL's numbers and their functions with eight values side by side, so that a shader's functions can run on
// the processor for eight pixels at once (shaders/README.md); vectors: lane_vectors.h. Names and meaning are
// GLSL's.
//
// A condition is a Mask, true in some lanes: `choose` takes its second or third argument lane by lane,
// `anyLane` says whether a branch can be left out. Everything is inlined into a function for
// runOnWidestVectors().
#pragma once

#include <cstddef>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::core::lanes {

/// Where vectors are eight wide they are loaded from whole multiples of their size, which compilers do not
/// keep to where they are not.
inline constexpr std::size_t kAlignment = sizeof(Eight);

struct alignas(kAlignment) Mask {
  EightInts v;
  Mask() = default;
  CATOPTRIC_INLINE Mask(bool all) : v(EightInts{} - std::int32_t(all)) {}
  CATOPTRIC_INLINE explicit Mask(EightInts lanes) : v(lanes) {}
};

CATOPTRIC_INLINE Mask operator&&(Mask a, Mask b) {
  return Mask(a.v & b.v);
}
CATOPTRIC_INLINE Mask operator||(Mask a, Mask b) {
  return Mask(a.v | b.v);
}
CATOPTRIC_INLINE Mask operator!=(Mask a, Mask b) {
  return Mask(a.v ^ b.v);
}
CATOPTRIC_INLINE Mask operator!(Mask a) {
  return Mask(~a.v);
}
CATOPTRIC_INLINE bool anyLane(Mask a) {
  return toBits(a.v) != 0;
}

struct alignas(kAlignment) Float {
  Eight v;
  Float() = default;
  CATOPTRIC_INLINE Float(float all) : v(Eight{} + all) {}
  CATOPTRIC_INLINE explicit Float(Eight lanes) : v(lanes) {}
  CATOPTRIC_INLINE Float& operator+=(Float b) {
    v += b.v;
    return *this;
  }
  CATOPTRIC_INLINE Float& operator*=(Float b) {
    v *= b.v;
    return *this;
  }
};

CATOPTRIC_INLINE Float operator+(Float a, Float b) {
  return Float(a.v + b.v);
}
CATOPTRIC_INLINE Float operator-(Float a, Float b) {
  return Float(a.v - b.v);
}
CATOPTRIC_INLINE Float operator*(Float a, Float b) {
  return Float(a.v * b.v);
}
CATOPTRIC_INLINE Float operator/(Float a, Float b) {
  return Float(a.v / b.v);
}
CATOPTRIC_INLINE Float operator-(Float a) {
  return Float(-a.v);
}
CATOPTRIC_INLINE Mask operator<(Float a, Float b) {
  return Mask(a.v < b.v);
}
CATOPTRIC_INLINE Mask operator>(Float a, Float b) {
  return Mask(a.v > b.v);
}
CATOPTRIC_INLINE Mask operator<=(Float a, Float b) {
  return Mask(a.v <= b.v);
}
CATOPTRIC_INLINE Mask operator>=(Float a, Float b) {
  return Mask(a.v >= b.v);
}
CATOPTRIC_INLINE Mask operator==(Float a, Float b) {
  return Mask(a.v == b.v);
}
CATOPTRIC_INLINE Mask operator!=(Float a, Float b) {
  return Mask(a.v != b.v);
}

CATOPTRIC_INLINE Float choose(Mask c, Float a, Float b) {
  return Float(c.v ? a.v : b.v);
}
CATOPTRIC_INLINE Float min(Float a, Float b) {
  return Float(a.v < b.v ? a.v : b.v);
}
CATOPTRIC_INLINE Float max(Float a, Float b) {
  return Float(a.v > b.v ? a.v : b.v);
}
CATOPTRIC_INLINE Float clamp(Float a, Float least, Float most) {
  return min(max(a, least), most);
}
CATOPTRIC_INLINE Float abs(Float a) {
  return Float(Eight(EightInts(a.v) & 0x7fffffff));
}
CATOPTRIC_INLINE Float sqrt(Float a) {
  return Float(squareRoot(a.v));
}
CATOPTRIC_INLINE Float mix(Float a, Float b, Float t) {
  return a * (1.0f - t) + b * t;
}

/// Towards zero; what no integer holds becomes some integer.
CATOPTRIC_INLINE EightInts toInts(Float a) {
  return __builtin_convertvector(a.v, EightInts);
}
CATOPTRIC_INLINE Float fromInts(EightInts a) {
  return Float(__builtin_convertvector(a, Eight));
}
/// Of numbers that an integer holds.
CATOPTRIC_INLINE Float floor(Float a) {
  const Float whole = fromInts(toInts(a));
  return whole - choose(whole > a, 1.0f, 0.0f);
}

CATOPTRIC_INLINE Float evaluate(Float, float last) {
  return last;
}
/// c0 + c1 x + ...
template <class... More>
CATOPTRIC_INLINE Float evaluate(Float x, float c0, More... more) {
  return evaluate(x, more...) * x + c0;
}

// Chebyshev fits of our own; the errors are those of the fit.

/// Relative error 1e-7 where 2^a is a normal number.
CATOPTRIC_INLINE Float exp2(Float a) {
  const Float tame = clamp(a, -126.0f, 126.0f), whole = floor(tame);
  const Float fraction = evaluate(tame - whole, 0.99999990f, 0.69315462f, 0.24014077f, 0.055863283f,
                                  0.0089462147f, 0.0018951073f);
  return Float(Eight(EightInts(fraction.v) + (toInts(whole) << 23)));
}

/// Error 1.3e-6; of positive normal numbers.
CATOPTRIC_INLINE Float log2(Float a) {
  const EightInts bits = EightInts(a.v);
  const Float mantissa(Eight((bits & 0x007fffff) | 0x3f800000));
  const Float m = mantissa - 1.0f;
  return fromInts((bits >> 23) - 127) + m * evaluate(m, 1.44269326f, -0.72116273f, 0.47770593f, -0.33924777f,
                                                     0.21558853f, -0.096066249f, 0.020490346f);
}

/// Error 5e-7 radians; atan(0, 0) is 0.
CATOPTRIC_INLINE Float atan(Float y, Float x) {
  const Float longer = max(abs(x), abs(y)), shorter = min(abs(x), abs(y));
  const Float t = shorter / max(longer, 1.0e-30f);
  Float angle = t * evaluate(t * t, 0.99999933f, -0.33326375f, 0.19879872f, -0.13480406f, 0.083741557f,
                             -0.036898629f, 0.0078254829f);
  angle = choose(abs(y) > abs(x), 1.57079633f - angle, angle);
  angle = choose(x < 0.0f, 3.14159265f - angle, angle);
  return choose(y < 0.0f, -angle, angle);
}

CATOPTRIC_INLINE Float acos(Float a) {
  return atan(sqrt(max((1.0f - a) * (1.0f + a), 0.0f)), a);
}

CATOPTRIC_INLINE Float exp(Float a) {
  return exp2(a * 1.44269504f);
}

}  // namespace catoptric::core::lanes
