// SPDX-License-Identifier: Apache-2.0
// Gauss-Newton's step towards the ray through a point, for eight searches side by side.
//
// In: where each search stands in the table, its scene point. Out: the step, and what is seen after it.
//   1. Direction r of the ray and distance D of its first mirror point are bilinear in the texel coordinates.
//      Two texels of a row are one vector. Rows are mixed first; then 8 x 8 numbers are turned, so that from
//      here on a vector holds one number of eight searches, and columns are mixed.
//   2. After one mirror the origin is o = D h, with h the direction that the chart gives; after several it is
//      stored and interpolated as r is.
//   3. The residual is w = e - t r with e = Q - o and t = e.r / r.r: what is missing from the ray to Q,
//      across the ray. Columns a = o_x + t r_x and b = o_y + t r_y, made perpendicular to r; 2 x 2 normal
//      equations.
//   4. After the step: the mirror point lies in the direction that the chart gives, at the interpolated
//      distance.
//
// All in the table's frame. Source: find_ray.cpp.
#include "catoptric/reflection_morphing/ray_lanes.h"

#include <cmath>
#include <cstring>

#include "catoptric/core/widest_vectors.h"

namespace catoptric::reflection_morphing {
namespace {

/// One number of eight searches, or two neighbours of a row.
using Eight = float __attribute__((vector_size(32)));
using EightInts = std::int32_t __attribute__((vector_size(32)));
using Eights = Eight[8];
static_assert(2 * sizeof(vec4) == sizeof(Eight) && kRayLanes == 8);

/// Four numbers, bilinear in the cell, and their derivatives along x and y.
struct Mixed {
  Eight value[4], dx[4], dy[4];
};

CATOPTRIC_INLINE Eight load(const float* from) {
  Eight value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class Number, class Vector>
CATOPTRIC_INLINE void store(Number* to, const Vector& value) {
  static_assert(sizeof(Number) * kRayLanes == sizeof(Vector));
  std::memcpy(to, &value, sizeof value);
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

/// Step 1. `cell` is the index of each cell's lower corner; u, v where in it each search stands, 0 to 1.
CATOPTRIC_INLINE Mixed mix(const vec4* texels, int size, const EightInts& cell, const Eight& u,
                           const Eight& v) {
  Eights across, along;  // rows mixed, and their difference
  for (int i = 0; i < 8; ++i) {
    const Eight low = load(&texels[cell[i]].x), high = load(&texels[cell[i] + size].x);
    along[i] = high - low;
    across[i] = low + v[i] * along[i];
  }
  transpose(across);
  transpose(along);
  Mixed m;
  for (int k = 0; k < 4; ++k) {
    m.dx[k] = across[k + 4] - across[k];
    m.value[k] = across[k] + u * m.dx[k];
    m.dy[k] = along[k] + u * (along[k + 4] - along[k]);
  }
  return m;
}

/// Step 2 for one mirror: distance times the direction of the chart.
CATOPTRIC_INLINE Mixed computeOrigins(const RayTable& table, const Eight& cx, const Eight& cy,
                                      const Mixed& rays) {
  const Eight k = 2.0f / (1.0f + cx * cx + cy * cy);
  const Eight kx = -k * k * cx * table.step.x, ky = -k * k * cy * table.step.y;
  const Eight h[3] = {k * cx, k * cy, k - 1.0f};
  const Eight hx[3] = {k * table.step.x + cx * kx, cy * kx, kx};
  const Eight hy[3] = {cx * ky, k * table.step.y + cy * ky, ky};
  Mixed m;
  for (int i = 0; i < 3; ++i) {
    m.value[i] = rays.value[3] * h[i];
    m.dx[i] = rays.dx[3] * h[i] + rays.value[3] * hx[i];
    m.dy[i] = rays.dy[3] * h[i] + rays.value[3] * hy[i];
  }
  return m;
}

struct Step {
  Eight x, y;
};

/// Step 3.
CATOPTRIC_INLINE Step computeStep(int size, const Mixed& rays, const Mixed& origins, const Eight* q,
                                  RayLanes& s) {
  const Eight* r = rays.value;
  const Eight e[3] = {q[0] - origins.value[0], q[1] - origins.value[1], q[2] - origins.value[2]};
  const Eight er = dot(e, r), inverse = 1.0f / dot(r, r), reach = larger(er * inverse, Eight{});
  const Eight perRr = er > 0.0f ? inverse : Eight{};  // 0: the ray ends at its origin
  Eight w[3], a[3], b[3];
  for (int k = 0; k < 3; ++k) {
    w[k] = e[k] - reach * r[k];
    a[k] = origins.dx[k] + reach * rays.dx[k];
    b[k] = origins.dy[k] + reach * rays.dy[k];
  }
  // The part of a and b along r is taken out of their products; w has none.
  const Eight ar = dot(a, r), br = dot(b, r), aw = dot(a, w), bw = dot(b, w);
  const Eight aa = dot(a, a) - ar * ar * perRr, ab = dot(a, b) - ar * br * perRr,
              bb = dot(b, b) - br * br * perRr;
  // Near a focus the rays of a neighbourhood meet and no step says which; a little damping keeps it finite.
  const Eight perDeterminant = 1.0f / larger(aa * bb - ab * ab, 1e-6f * (aa + bb) * (aa + bb) + 1e-30f);
  const Eight x = (bb * aw - ab * bw) * perDeterminant, y = (aa * bw - ab * aw) * perDeterminant;
  const Eight squared = x * x + y * y, most = Eight{} + 0.25f * float(size);
  const Eight scale = most / larger(squareRoot(squared), most);
  store(s.isShort, squared < kLastStep * kLastStep);
  store(s.isAhead, er > 0.0f);
  return {x * scale, y * scale};
}

/// Where the step leads in the table.
CATOPTRIC_INLINE void findNextCells(int size, const Eight& x, const Eight& y, RayLanes& s) {
  const float end = float(size - 1);
  const EightInts isOnMap = (x >= 0.0f) & (y >= 0.0f) & (x < end) & (y < end);
  const Eight safeX = isOnMap ? x : Eight{}, safeY = isOnMap ? y : Eight{};
  const EightInts column = __builtin_convertvector(safeX, EightInts),
                  row = __builtin_convertvector(safeY, EightInts);
  const EightInts isRight = safeX - __builtin_convertvector(column, Eight) >= 0.5f,
                  isUpper = safeY - __builtin_convertvector(row, Eight) >= 0.5f;
  store(s.nextX, x);
  store(s.nextY, y);
  store(s.nextCell, (row * size + column) | ~isOnMap);
  store(s.nextCorner, (isRight & 1) | (isUpper & 2));
}

/// Step 4.
CATOPTRIC_INLINE void finish(const RayTable& table, const Mixed& rays, const Mixed& origins, const Eight* q,
                             const Step& step, const Eight& nextX, const Eight& nextY, RayLanes& s) {
  const auto after = [&](const Mixed& m, int n) __attribute__((always_inline)) {
    return m.value[n] + step.x * m.dx[n] + step.y * m.dy[n];
  };
  const Eight cx = table.lower.x + nextX * table.step.x, cy = table.lower.y + nextY * table.step.y;
  const Eight k = 2.0f / (1.0f + cx * cx + cy * cy);
  const Eight distance = larger(after(rays, 3), 0.01f * rays.value[3]);
  const Eight mirror[3] = {k * cx * distance, k * cy * distance, (k - 1.0f) * distance};
  const bool isOne = table.origins.empty();
  Eight toPoint[3];
  for (int i = 0; i < 3; ++i) {
    store(s.mirror[i], table.location[i] + mirror[0] * table.chart.right[i] + mirror[1] * table.chart.up[i] +
                           mirror[2] * table.chart.axis[i]);
    toPoint[i] = q[i] - (isOne ? mirror[i] : after(origins, i));
  }
  const Eight rest = squareRoot(dot(toPoint, toPoint));
  store(s.rest, isOne ? rest : larger(after(origins, 3), Eight{}) + rest);
}

struct EvaluateAll {
  CATOPTRIC_INLINE static void run(const RayTable& table, RayLanes& s) {
    const Eight x = load(s.x), y = load(s.y);
    const EightInts column = __builtin_convertvector(x, EightInts),
                    row = __builtin_convertvector(y, EightInts), cell = row * table.size + column;
    const Eight u = x - __builtin_convertvector(column, Eight), v = y - __builtin_convertvector(row, Eight);
    const Mixed rays = mix(table.leaving.data(), table.size, cell, u, v);
    const Mixed origins = table.origins.empty() ? computeOrigins(table, table.lower.x + x * table.step.x,
                                                                 table.lower.y + y * table.step.y, rays)
                                                : mix(table.origins.data(), table.size, cell, u, v);
    const Eight e[3] = {load(s.point[0]) - table.location.x, load(s.point[1]) - table.location.y,
                        load(s.point[2]) - table.location.z};
    const auto turn = [&](const vec3& axis) __attribute__((always_inline)) {
      return e[0] * axis.x + e[1] * axis.y + e[2] * axis.z;
    };
    const Eight q[3] = {turn(table.chart.right), turn(table.chart.up), turn(table.chart.axis)};
    const Step step = computeStep(table.size, rays, origins, q, s);
    const Eight nextX = x + step.x, nextY = y + step.y;
    findNextCells(table.size, nextX, nextY, s);
    finish(table, rays, origins, q, step, nextX, nextY, s);
  }
};

}  // namespace

void evaluateRayLanes(const RayTable& table, RayLanes& lanes) {
  core::runOnWidestVectors<EvaluateAll>(table, lanes);
}

}  // namespace catoptric::reflection_morphing
