// SPDX-License-Identifier: Apache-2.0
// The mirror law and Newton's step of reflection_point.h for eight places side by side, in float.
//
// In: eight triangles of the mirror, a place (u, v) on each, the eye, eight scene points. Out: how far each
// place is from holding the law, and the step towards where it holds.
//
// Frame: world axes, origin at the mirror's centre, so that floats carry the accuracy where it counts. Only
// for files that src/catoptric/CMakeLists.txt gives the flags of core/eight_lanes.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/math.h"
#include "catoptric/virtual_object/lane_search.h"

namespace catoptric::virtual_object {

using core::Eight;
using core::EightInts;
using core::Eights;
using core::larger;
using core::load;
using core::smaller;
using core::squareRoot;
using core::store;

struct LaneVector {
  Eight v[3];
};

CATOPTRIC_INLINE LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]}};
}
CATOPTRIC_INLINE LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2]}};
}
CATOPTRIC_INLINE LaneVector operator*(const Eight& s, const LaneVector& a) {
  return {{s * a.v[0], s * a.v[1], s * a.v[2]}};
}
CATOPTRIC_INLINE LaneVector broadcast(const vec3& a) {
  return {{Eight{} + a.x, Eight{} + a.y, Eight{} + a.z}};
}
CATOPTRIC_INLINE Eight dot(const LaneVector& a, const LaneVector& b) {
  return core::dot(a.v, b.v);
}
CATOPTRIC_INLINE LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
           a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}
CATOPTRIC_INLINE LaneVector loadVector(const LaneFloats* from) {
  return {{load(from[0]), load(from[1]), load(from[2])}};
}
CATOPTRIC_INLINE void storeVector(LaneFloats* to, const LaneVector& a) {
  for (int k = 0; k < 3; ++k) store(to[k], a.v[k]);
}

/// By how far (u, v) lies outside of its triangle; negative inside.
CATOPTRIC_INLINE Eight outsideBy(const Eight& u, const Eight& v) {
  return larger(larger(-u, -v), u + v - 1.0f);
}

/// Meanings as in MirrorTriangle.
struct Triangles {
  LaneVector position0, edge1, edge2, normal0, normal1, normal2;
  Eight gram11, gram12, gram22;
};

CATOPTRIC_INLINE void gather(std::span<const LaneTriangle> from, const EightInts& ids, Triangles& t) {
  static_assert(sizeof(LaneTriangle) == 128 && offsetof(LaneTriangle, neighbours) == 84);
  Eight columns[24];
  for (int k = 0; k < 3; ++k) {
    Eights rows;
    for (int i = 0; i < kLanes; ++i) rows[i] = load(&from[std::uint32_t(ids[i])].position0.x + 8 * k);
    core::transpose(rows);
    for (int i = 0; i < 8; ++i) columns[8 * k + i] = rows[i];
  }
  const auto vector = [&](int k) __attribute__((always_inline)) {
    return LaneVector{{columns[k], columns[k + 1], columns[k + 2]}};
  };
  t.position0 = vector(0), t.edge1 = vector(3), t.edge2 = vector(6);
  t.normal0 = vector(9), t.normal1 = vector(12), t.normal2 = vector(15);
  t.gram11 = columns[18], t.gram12 = columns[19], t.gram22 = columns[20];
}

/// Where a line meets a triangle's plane.
struct PlaneMeeting {
  Eight fraction;  ///< of the way from `origin` on, `along` long
  Eight u, v;
};
CATOPTRIC_INLINE PlaneMeeting meetPlane(const Triangles& t, const LaneVector& origin,
                                        const LaneVector& along) {
  const LaneVector facet = cross(t.edge1, t.edge2);
  PlaneMeeting meeting;
  meeting.fraction = dot(facet, t.position0 - origin) / dot(facet, along);
  const LaneVector d = (origin + meeting.fraction * along) - t.position0;
  const Eight a = dot(t.edge1, d), b = dot(t.edge2, d);
  meeting.u = t.gram11 * a + t.gram12 * b, meeting.v = t.gram12 * a + t.gram22 * b;
  return meeting;
}

/// As LaneLaw.
struct Law {
  Eight squaredSine, squaredMerit, squaredHalf, facing, distance, stepU, stepV;
};

/// MirrorLaw and computeNewtonStep of reflection_point.h, in the same order.
CATOPTRIC_INLINE Law evaluate(const Triangles& t, const Eight& u, const Eight& v, const LaneVector& eye,
                              const LaneVector& point) {
  const LaneVector p = t.position0 + u * t.edge1 + v * t.edge2;
  const LaneVector n = t.normal0 + u * t.normal1 + v * t.normal2;
  const LaneVector toEye = eye - p, toPoint = point - p;
  const Eight a = squareRoot(dot(toEye, toEye)), b = squareRoot(dot(toPoint, toPoint));
  const Eight inverse = 1.0f / (a * b * (a + b));
  const Eight inverseA = b * (a + b) * inverse, inverseB = a * (a + b) * inverse,
              inverseSum = a * b * inverse;
  const LaneVector wi = inverseA * toEye, wo = inverseB * toPoint;
  // Half vector h and its part across the normal, q.
  const LaneVector h = wi + wo;
  const Eight nn = dot(n, n), hn = dot(h, n);
  const LaneVector q = nn * h - hn * n;
  Law law;
  const Eight qq = dot(q, q), harmonic = a * b * inverseSum;
  law.squaredHalf = dot(h, h);
  law.squaredSine = qq / (law.squaredHalf * nn * nn);
  law.squaredMerit = harmonic * harmonic * law.squaredSine * law.squaredHalf;
  law.facing = hn;
  law.distance = b;
  // Derivatives along both edges.
  const Eight both = inverseA + inverseB, eyeShare = b * inverseSum, pointShare = a * inverseSum;
  const auto derive = [&](const LaneVector& e, const LaneVector& m) __attribute__((always_inline)) {
    const Eight ieA = dot(e, wi) * inverseA, oeB = dot(e, wo) * inverseB;
    const LaneVector dh = ieA * wi + oeB * wo - both * e;
    const Eight dNn = 2.0f * dot(m, n), dHn = dot(dh, n) + dot(m, h);
    const Eight dLogS = -(ieA * eyeShare + oeB * pointShare);
    return dNn * h + nn * dh - dHn * n - hn * m + dLogS * q;
  };
  const LaneVector d1 = derive(t.edge1, t.normal1), d2 = derive(t.edge2, t.normal2);
  // Two equations e1.q = e2.q = 0 in (u, v).
  const Eight f1 = dot(t.edge1, q), f2 = dot(t.edge2, q);
  const Eight j11 = dot(d1, t.edge1), j12 = dot(d2, t.edge1), j21 = dot(d1, t.edge2), j22 = dot(d2, t.edge2);
  const Eight inverseDeterminant = 1.0f / (j11 * j22 - j12 * j21);
  law.stepU = (j12 * f2 - j22 * f1) * inverseDeterminant;
  law.stepV = (j21 * f1 - j11 * f2) * inverseDeterminant;
  return law;
}

}  // namespace catoptric::virtual_object
