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
#pragma once

#include "catoptric/core/eight_lanes.h"
#include "catoptric/reflection_morphing/ray_table.h"

namespace catoptric::reflection_morphing {

using core::dot;
using core::Eight;
using core::EightInts;
using core::Eights;
using core::fromBits;
using core::kLanes;
using core::larger;
using core::load;
using core::squareRoot;
using core::store;
using core::toBits;
using core::transpose;

inline constexpr float kLastStep = 0.08f;  ///< texels; what it leaves is some thousandths of a texel

/// Where a step leads.
struct RayStep {
  Eight x, y;           ///< texels; at most a quarter of the table away
  EightInts isShort;    ///< shorter than kLastStep
  EightInts isAhead;    ///< the point lies the way the ray goes
  EightInts isOnTable;  ///< there is a cell
  EightInts cell;       ///< its index, 0 if there is none
  EightInts corner;     ///< which corner of it is nearest, as in RayTable::cells
  Eight mirror[3];      ///< first mirror point after the step, world
  Eight rest;           ///< from there to the scene point
};

namespace ray_lanes {

/// Four numbers, bilinear in the cell, and their derivatives along x and y.
struct Mixed {
  Eight value[4], dx[4], dy[4];
};

/// Step 1. `cell` is the index of each cell's lower corner; u, v where in it each search stands, 0 to 1.
CATOPTRIC_INLINE Mixed mix(const vec4* texels, int size, const EightInts& cell, const Eight& u,
                           const Eight& v) {
  static_assert(2 * sizeof(vec4) == sizeof(Eight));
  Eights across, along;  // rows mixed, and their difference
  for (int i = 0; i < kLanes; ++i) {
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
                                  RayStep& s) {
  const Eight* r = rays.value;
  const Eight e[3] = {q[0] - origins.value[0], q[1] - origins.value[1], q[2] - origins.value[2]};
  const Eight er = dot(e, r), inverse = 1.0f / dot(r, r), reach = larger(er * inverse, Eight{});
  s.isAhead = er > 0.0f;
  const Eight perRr = s.isAhead ? inverse : Eight{};  // 0: the ray ends at its origin
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
  const Eight squared = x * x + y * y;
  s.isShort = squared < kLastStep * kLastStep;
  const float most = 0.25f * float(size);
  if (toBits(squared > most * most) == 0) return {x, y};  // all but the first steps of some searches
  const Eight scale = most / larger(squareRoot(squared), Eight{} + most);
  return {x * scale, y * scale};
}

CATOPTRIC_INLINE void findCells(int size, RayStep& s) {
  const float end = float(size - 1);
  s.isOnTable = (s.x >= 0.0f) & (s.y >= 0.0f) & (s.x < end) & (s.y < end);
  const Eight x = s.isOnTable ? s.x : Eight{}, y = s.isOnTable ? s.y : Eight{};
  const EightInts column = __builtin_convertvector(x, EightInts), row = __builtin_convertvector(y, EightInts);
  const EightInts isRight = x - __builtin_convertvector(column, Eight) >= 0.5f,
                  isUpper = y - __builtin_convertvector(row, Eight) >= 0.5f;
  s.cell = row * size + column;
  s.corner = (isRight & 1) | (isUpper & 2);
}

/// Step 4.
CATOPTRIC_INLINE void finish(const RayTable& table, const Mixed& rays, const Mixed& origins, const Eight* q,
                             const Step& step, RayStep& s) {
  const auto after = [&](const Mixed& m, int n) __attribute__((always_inline)) {
    return m.value[n] + step.x * m.dx[n] + step.y * m.dy[n];
  };
  const Eight cx = table.lower.x + s.x * table.step.x, cy = table.lower.y + s.y * table.step.y;
  const Eight k = 2.0f / (1.0f + cx * cx + cy * cy);
  const Eight distance = larger(after(rays, 3), 0.01f * rays.value[3]);
  const Eight mirror[3] = {k * cx * distance, k * cy * distance, (k - 1.0f) * distance};
  const bool isOne = table.origins.empty();
  Eight toPoint[3];
  for (int i = 0; i < 3; ++i) {
    s.mirror[i] = table.location[i] + mirror[0] * table.chart.right[i] + mirror[1] * table.chart.up[i] +
                  mirror[2] * table.chart.axis[i];
    toPoint[i] = q[i] - (isOne ? mirror[i] : after(origins, i));
  }
  s.rest = squareRoot(dot(toPoint, toPoint));
  if (!isOne) s.rest += larger(after(origins, 3), Eight{});
}

}  // namespace ray_lanes

/// One step of eight searches that stand at (x, y), in texels, where the table is filled; `point` in world
/// space.
CATOPTRIC_INLINE RayStep makeRayStep(const RayTable& table, const Eight& x, const Eight& y,
                                     const Eight* point) {
  using namespace ray_lanes;
  const EightInts column = __builtin_convertvector(x, EightInts), row = __builtin_convertvector(y, EightInts),
                  cell = row * table.size + column;
  const Eight u = x - __builtin_convertvector(column, Eight), v = y - __builtin_convertvector(row, Eight);
  const Mixed rays = mix(table.leaving.data(), table.size, cell, u, v);
  const Mixed origins = table.origins.empty() ? computeOrigins(table, table.lower.x + x * table.step.x,
                                                               table.lower.y + y * table.step.y, rays)
                                              : mix(table.origins.data(), table.size, cell, u, v);
  const Eight e[3] = {point[0] - table.location.x, point[1] - table.location.y, point[2] - table.location.z};
  const auto turn = [&](const vec3& axis) __attribute__((always_inline)) {
    return e[0] * axis.x + e[1] * axis.y + e[2] * axis.z;
  };
  const Eight q[3] = {turn(table.chart.right), turn(table.chart.up), turn(table.chart.axis)};
  RayStep s;
  const Step step = computeStep(table.size, rays, origins, q, s);
  s.x = x + step.x;
  s.y = y + step.y;
  findCells(table.size, s);
  finish(table, rays, origins, q, step, s);
  return s;
}

}  // namespace catoptric::reflection_morphing
