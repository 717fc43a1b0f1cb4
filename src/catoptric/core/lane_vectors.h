// SPDX-License-Identifier: Apache-2.0
// GLSL's vectors and their functions, eight side by side (lanes.h).
#pragma once

#include <concepts>

#include "catoptric/core/lanes.h"
#include "catoptric/core/math.h"

namespace catoptric::core::lanes {

struct Vec2 {
  static constexpr int kSize = 2;
  Float x, y;
  Vec2() = default;
  CATOPTRIC_INLINE explicit Vec2(Float all) : x(all), y(all) {}
  CATOPTRIC_INLINE Vec2(Float a, Float b) : x(a), y(b) {}
  CATOPTRIC_INLINE Vec2(const ivec2& all) : x(float(all.x)), y(float(all.y)) {}
  template <class Longer>
  requires(Longer::kSize > 2) CATOPTRIC_INLINE explicit Vec2(const Longer& v) : x(v.x), y(v.y) {}
  CATOPTRIC_INLINE Float& operator[](int i) { return i == 0 ? x : y; }
  CATOPTRIC_INLINE const Float& operator[](int i) const { return i == 0 ? x : y; }
};

struct Vec3 {
  static constexpr int kSize = 3;
  Float x, y, z;
  Vec3() = default;
  CATOPTRIC_INLINE explicit Vec3(Float all) : x(all), y(all), z(all) {}
  CATOPTRIC_INLINE Vec3(Float a, Float b, Float c) : x(a), y(b), z(c) {}
  CATOPTRIC_INLINE Vec3(const Vec2& v, Float c) : x(v.x), y(v.y), z(c) {}
  CATOPTRIC_INLINE Vec3(const vec3& all) : x(all.x), y(all.y), z(all.z) {}
  template <class Longer>
  requires(Longer::kSize > 3) CATOPTRIC_INLINE explicit Vec3(const Longer& v) : x(v.x), y(v.y), z(v.z) {}
  CATOPTRIC_INLINE Float& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  CATOPTRIC_INLINE const Float& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

struct Vec4 {
  static constexpr int kSize = 4;
  Float x, y, z, w;
  Vec4() = default;
  CATOPTRIC_INLINE explicit Vec4(Float all) : x(all), y(all), z(all), w(all) {}
  CATOPTRIC_INLINE Vec4(Float a, Float b, Float c, Float d) : x(a), y(b), z(c), w(d) {}
  CATOPTRIC_INLINE Vec4(const vec4& all) : x(all.x), y(all.y), z(all.z), w(all.w) {}
  CATOPTRIC_INLINE Float& operator[](int i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
  CATOPTRIC_INLINE const Float& operator[](int i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};

template <class V>
concept IsVector = std::same_as<V, Vec2> || std::same_as<V, Vec3> || std::same_as<V, Vec4>;

template <IsVector V>
CATOPTRIC_INLINE V operator+(const V& a, const V& b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = a[i] + b[i];
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V operator-(const V& a, const V& b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = a[i] - b[i];
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V operator*(const V& a, const V& b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = a[i] * b[i];
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V operator*(const V& a, Float b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = a[i] * b;
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V operator*(Float a, const V& b) {
  return b * a;
}
template <IsVector V>
CATOPTRIC_INLINE V operator/(const V& a, Float b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = a[i] / b;
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V operator-(const V& a) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = -a[i];
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V& operator+=(V& a, const V& b) {
  return a = a + b;
}
template <IsVector V>
CATOPTRIC_INLINE V& operator*=(V& a, const V& b) {
  return a = a * b;
}
template <IsVector V>
CATOPTRIC_INLINE V& operator*=(V& a, Float b) {
  return a = a * b;
}
template <IsVector V>
CATOPTRIC_INLINE V& operator-=(V& a, const V& b) {
  return a = a - b;
}

template <IsVector V>
CATOPTRIC_INLINE V choose(Mask c, const V& a, const V& b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = choose(c, a[i], b[i]);
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V mix(const V& a, const V& b, Float t) {
  return a * (1.0f - t) + b * t;
}
template <IsVector V>
CATOPTRIC_INLINE V max(const V& a, const V& b) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = max(a[i], b[i]);
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE V clamp(const V& a, const V& least, const V& most) {
  V r;
  for (int i = 0; i < V::kSize; ++i) r[i] = clamp(a[i], least[i], most[i]);
  return r;
}
template <IsVector V>
CATOPTRIC_INLINE Float dot(const V& a, const V& b) {
  Float sum = a[0] * b[0];
  for (int i = 1; i < V::kSize; ++i) sum += a[i] * b[i];
  return sum;
}
template <IsVector V>
CATOPTRIC_INLINE Float length(const V& a) {
  return sqrt(dot(a, a));
}
template <IsVector V>
CATOPTRIC_INLINE V normalize(const V& a) {
  return a * (1.0f / length(a));
}
CATOPTRIC_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
CATOPTRIC_INLINE Vec3 reflect(const Vec3& v, const Vec3& n) {
  return v - n * (2.0f * dot(n, v));
}
CATOPTRIC_INLINE Vec3 refract(const Vec3& v, const Vec3& n, Float eta) {
  const Float cosine = dot(n, v), k = 1.0f - eta * eta * (1.0f - cosine * cosine);
  return choose(k < 0.0f, Vec3(0.0f), v * eta - n * (eta * cosine + sqrt(max(k, 0.0f))));
}
CATOPTRIC_INLINE Vec3 exp(const Vec3& a) {
  return {exp(a.x), exp(a.y), exp(a.z)};
}

/// A row of four numbers for each lane.
CATOPTRIC_INLINE Vec4 loadRows(const vec4* const (&rows)[kLanes]) {
  using Four = float __attribute__((vector_size(16)));
  Eight pairs[4];  // lanes i and i + 4
  for (int i = 0; i < 4; ++i) {
    Four low, high;
    std::memcpy(&low, rows[i], sizeof low);
    std::memcpy(&high, rows[i + 4], sizeof high);
    pairs[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Eight xy01 = __builtin_shufflevector(pairs[0], pairs[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight zw01 = __builtin_shufflevector(pairs[0], pairs[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Eight xy23 = __builtin_shufflevector(pairs[2], pairs[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight zw23 = __builtin_shufflevector(pairs[2], pairs[3], 2, 10, 3, 11, 6, 14, 7, 15);
  return {Float(__builtin_shufflevector(xy01, xy23, 0, 1, 8, 9, 4, 5, 12, 13)),
          Float(__builtin_shufflevector(xy01, xy23, 2, 3, 10, 11, 6, 7, 14, 15)),
          Float(__builtin_shufflevector(zw01, zw23, 0, 1, 8, 9, 4, 5, 12, 13)),
          Float(__builtin_shufflevector(zw01, zw23, 2, 3, 10, 11, 6, 7, 14, 15))};
}

}  // namespace catoptric::core::lanes
