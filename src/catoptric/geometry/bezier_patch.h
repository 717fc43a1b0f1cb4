// SPDX-License-Identifier: Apache-2.0
// Bicubic Bezier patches with exact normals, also where an edge of the patch shrinks to a point.
#pragma once

#include <array>

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

/// S(u, v) = sum of B_i(v) B_j(u) control[4 i + j]: rows run along v, columns along u.
struct BicubicPatch {
  std::array<dvec3, 16> control;
};

struct PatchPoint {
  dvec3 position;
  dvec3 normal;  ///< unit, along dS/du x dS/dv
};

/// The point at (u, v) in [0, 1]^2. Where dS/du x dS/dv vanishes the normal is its limit from inside the
/// patch.
[[nodiscard]] PatchPoint evaluatePatch(const BicubicPatch& patch, double u, double v);

/// cellsU x cellsV quads, front on the side of the normal (on the other one if turned over); texture (u, v);
/// triangles that a degenerate edge makes empty are left out.
[[nodiscard]] Mesh tessellatePatch(const BicubicPatch& patch, int cellsU, int cellsV,
                                   bool turnedOver = false);

/// The patch A(u) + B(v) swept by moving one cubic curve along the other. With A a strictly convex curve in
/// the xz plane and B one in the yz plane, both bending towards -z, it is strictly convex: z is a sum f(x) +
/// g(y).
[[nodiscard]] BicubicPatch makeTranslationalPatch(const std::array<dvec3, 4>& alongU,
                                                  const std::array<dvec3, 4>& alongV);

}  // namespace catoptric::geometry
