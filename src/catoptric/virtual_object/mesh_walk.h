// SPDX-License-Identifier: Apache-2.0
// Walking over the mirror: a step that leaves a triangle goes on in the neighbour, unfolded into its plane.
// One text for the double search (reflection_point.h) and for the lanes in float (mirror_law_lanes.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// Moves `at` by (du, dv) of its triangle, across edges as they come. False where that leads past the end of
/// the mesh, with (u, v) outside of the last triangle, or takes more than `maxCrossings`. Triangle: edge1,
/// edge2, gram11, gram12, gram22, neighbours, as MirrorTriangle. Point: triangle, u, v.
template <class Triangle, class Point, class Real>
bool walkOverMesh(std::span<const Triangle> triangles, Point& at, Real du, Real dv, int maxCrossings) {
  constexpr int kNoEdge = 3;
  int entered = kNoEdge;
  for (int crossing = 0; crossing < maxCrossings; ++crossing) {
    // Never straight back over the edge it came in by.
    if (entered == 0 && dv < 0) dv = 0;
    if (entered == 2 && du < 0) du = 0;
    if (entered == 1 && du + dv > 0) du = Real(0.5) * (du - dv), dv = -du;
    const Real u = at.u + du, v = at.v + dv;
    if (u >= 0 && v >= 0 && u + v <= 1) {
      at.u = u, at.v = v;
      return true;
    }
    // The first edge crossed that has a neighbour: edge 0 is v = 0, edge 1 is u + v = 1, edge 2 is u = 0.
    const Triangle& t = triangles[at.triangle];
    int edge = kNoEdge;
    Real first = 2;
    const auto consider = [&](int k, Real inside, Real change) {
      if (inside + change >= 0 || t.neighbours[std::size_t(k)] == kNoNeighbour) return;
      const Real fraction = change < 0 ? std::max(inside / -change, Real(0)) : Real(0);
      if (fraction < first) first = fraction, edge = k;
    };
    consider(0, at.v, dv);
    consider(1, 1 - at.u - at.v, -(du + dv));
    consider(2, at.u, du);
    if (edge == kNoEdge) {  // past the end of the mesh
      at.u = u, at.v = v;
      return false;
    }
    const Real cu = at.u + first * du, cv = at.v + first * dv;
    const Real back = 1 - (edge == 0 ? cu : edge == 1 ? cv : 1 - cv);
    const auto rest = (1 - first) * (du * t.edge1 + dv * t.edge2);
    const std::uint32_t link = t.neighbours[std::size_t(edge)];
    const Triangle& next = triangles[link / 4];
    entered = int(link % 4);
    at.triangle = link / 4;
    at.u = entered == 0 ? back : entered == 1 ? 1 - back : 0;
    at.v = entered == 0 ? 0 : entered == 1 ? back : 1 - back;
    const Real x = glm::dot(next.edge1, rest), y = glm::dot(next.edge2, rest);
    du = next.gram11 * x + next.gram12 * y;
    dv = next.gram12 * x + next.gram22 * y;
  }
  return false;
}

}  // namespace catoptric::virtual_object
