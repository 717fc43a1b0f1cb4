// SPDX-License-Identifier: Apache-2.0
// Gauss-Newton's step towards the ray through a point, for eight searches side by side.
//
// In: where each search stands in the map, its scene point. Out: the step, and what is seen after it.
//   1. Origin o and direction r of the ray are bilinear in the texel coordinates, as are both distances: the
//      eight numbers of a texel are one vector, four vectors give the value and both derivatives.
//   2. 8 x 8 numbers are turned, so that from here on a vector holds one number of eight searches.
//   3. The residual is w = e - t r with e = Q - o and t = e.r / r.r: what is missing from the ray to Q,
//   across
//      the ray. Columns a = o_x + t r_x and b = o_y + t r_y, made perpendicular to r; 2 x 2 normal equations.
//   4. After the step: the mirror point lies in the direction that the chart gives, at the interpolated
//      distance.
//
// Written once; the compiler makes it for the processors that everyone has and for AVX2. Products and sums
// are not fused, so both give the same bits. Cost: 12 ns a lane. Source: find_ray.cpp.
#include "catoptric/reflection_morphing/ray_lanes.h"

#include <cmath>
#include <cstring>

namespace catoptric::reflection_morphing {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define CATOPTRIC_HAS_AVX2_CLONE
#endif
#define CATOPTRIC_INLINE __attribute__((always_inline)) inline

/// A RayTexel, or one number of eight searches.
using Eight = float __attribute__((vector_size(32)));
using Eights = Eight[8];
static_assert(sizeof(RayTexel) == sizeof(Eight) && kRayLanes == 8);

/// Numbers of a texel.
enum : int { kOrigin = 0, kDistance = 3, kDirection = 4, kBetween = 7 };

/// Step 1.
CATOPTRIC_INLINE void interpolate(const RayTexel* cell, int size, float u, float v, Eight& value, Eight& dx,
                                  Eight& dy) {
  Eight t00, t10, t01, t11;
  std::memcpy(&t00, cell, sizeof t00);
  std::memcpy(&t10, cell + 1, sizeof t10);
  std::memcpy(&t01, cell + size, sizeof t01);
  std::memcpy(&t11, cell + size + 1, sizeof t11);
  const Eight top = t10 - t00, low = t11 - t01, left = t00 + u * top;
  dx = top + v * (low - top);
  dy = t01 + u * low - left;
  value = left + v * dy;
}

/// Step 2.
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

CATOPTRIC_INLINE Eight dot(const Eight* a, const Eight* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

CATOPTRIC_INLINE Eight squareRoot(Eight a) {
  for (int i = 0; i < 8; ++i) a[i] = std::sqrt(a[i]);
  return a;
}

CATOPTRIC_INLINE Eight larger(const Eight& a, const Eight& b) {
  return a > b ? a : b;
}

CATOPTRIC_INLINE Eight load(const float* from) {
  Eight value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

CATOPTRIC_INLINE void store(float* to, const Eight& value) {
  std::memcpy(to, &value, sizeof value);
}

/// Step 3.
CATOPTRIC_INLINE void computeSteps(const RayMap& map, const Eights& value, const Eights& dx, const Eights& dy,
                                   const Eight* q, RayLanes& s, Eight& stepX, Eight& stepY) {
  const Eight* r = value + kDirection;
  const Eight e[3] = {q[0] - value[0], q[1] - value[1], q[2] - value[2]};
  const Eight rr = dot(r, r), along = dot(e, r) / rr, reach = larger(along, Eight{});
  const Eight perRr = along > 0.0f ? 1.0f / rr : Eight{};  // 0: the ray ends at its origin
  Eight w[3], a[3], b[3];
  for (int k = 0; k < 3; ++k) {
    w[k] = e[k] - reach * r[k];
    a[k] = dx[k] + reach * dx[kDirection + k];
    b[k] = dy[k] + reach * dy[kDirection + k];
  }
  // The part of a and b along r is taken out of their products; w has none.
  const Eight ar = dot(a, r), br = dot(b, r), aw = dot(a, w), bw = dot(b, w);
  const Eight aa = dot(a, a) - ar * ar * perRr, ab = dot(a, b) - ar * br * perRr,
              bb = dot(b, b) - br * br * perRr;
  // Near a focus the rays of a neighbourhood meet and no step says which; a little damping keeps it finite.
  const Eight perDeterminant = 1.0f / larger(aa * bb - ab * ab, 1e-6f * (aa + bb) * (aa + bb) + 1e-30f);
  stepX = (bb * aw - ab * bw) * perDeterminant;
  stepY = (aa * bw - ab * aw) * perDeterminant;
  const Eight length = squareRoot(stepX * stepX + stepY * stepY), most = Eight{} + 0.25f * float(map.size);
  const Eight scale = most / larger(length, most);
  stepX *= scale;
  stepY *= scale;
  store(s.along, along);
  store(s.stepX, stepX);
  store(s.stepY, stepY);
}

/// Step 4.
CATOPTRIC_INLINE void finish(const RayMap& map, const Eights& value, const Eights& dx, const Eights& dy,
                             const Eight* q, const Eight& stepX, const Eight& stepY, RayLanes& s) {
  const auto after = [&](int n) __attribute__((always_inline)) {
    return value[n] + stepX * dx[n] + stepY * dy[n];
  };
  const Eight cx = map.lower.x + (load(s.x) + stepX) * map.step.x,
              cy = map.lower.y + (load(s.y) + stepY) * map.step.y;
  const Eight pp = cx * cx + cy * cy;
  const Eight distance = larger(after(kDistance), 0.01f * value[kDistance]) / (1.0f + pp);
  const Eight right = 2.0f * cx * distance, up = 2.0f * cy * distance, ahead = (1.0f - pp) * distance;
  Eight toPoint[3];
  for (int k = 0; k < 3; ++k) {
    store(s.mirror[k],
          map.location[k] + right * map.chart.right[k] + up * map.chart.up[k] + ahead * map.chart.axis[k]);
    toPoint[k] = q[k] - after(kOrigin + k);
  }
  store(s.rest, larger(after(kBetween), Eight{}) + squareRoot(dot(toPoint, toPoint)));
}

CATOPTRIC_INLINE void evaluateAll(const RayMap& map, RayLanes& s) {
  Eights value, dx, dy;
  for (int i = 0; i < kRayLanes; ++i)
    interpolate(s.cell[i], map.size, s.u[i], s.v[i], value[i], dx[i], dy[i]);
  transpose(value);
  transpose(dx);
  transpose(dy);
  const Eight q[3] = {load(s.point[0]), load(s.point[1]), load(s.point[2])};
  Eight stepX, stepY;
  computeSteps(map, value, dx, dy, q, s, stepX, stepY);
  finish(map, value, dx, dy, q, stepX, stepY, s);
}

void evaluateAnywhere(const RayMap& map, RayLanes& lanes) {
  evaluateAll(map, lanes);
}

#ifdef CATOPTRIC_HAS_AVX2_CLONE
__attribute__((target("avx2"))) void evaluateWithAvx2(const RayMap& map, RayLanes& lanes) {
  evaluateAll(map, lanes);
}
#endif

using Evaluate = void (*)(const RayMap&, RayLanes&);

Evaluate chooseEvaluate() {
#ifdef CATOPTRIC_HAS_AVX2_CLONE
  if (__builtin_cpu_supports("avx2")) return evaluateWithAvx2;
#endif
  return evaluateAnywhere;
}

}  // namespace

void evaluateRayLanes(const RayMap& map, RayLanes& lanes) {
  static const Evaluate evaluate = chooseEvaluate();
  evaluate(map, lanes);
}

}  // namespace catoptric::reflection_morphing
