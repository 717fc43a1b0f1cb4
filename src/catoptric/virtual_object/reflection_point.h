// SPDX-License-Identifier: Apache-2.0
// The per-vertex mathematics of the refined solver, as pure functions over the mirror's triangles: what a GPU
// version has to repeat.
//
// Question: where on a mirror (flat triangles, linear normals) does the eye E see the scene point Q?
//   The mirror law: the half vector h = unit(E - P) + unit(Q - P) is parallel to the normal n at P = J.
//   Residual: q = h - lambda n with lambda = (h.n)/(n.n), the part of h across n, times s =
//   |EP||QP|/(|EP|+|QP|). Two equations, s e1.q = s e2.q = 0 with the edges of the triangle, in its two
//   unknowns (u, v), derivatives exact.
// The factor s turns h into a vector that ends on the segment EQ. Without it Newton overshoots for points
// close to the mirror, where unit(Q - P) swings round within a short way. Walking: a step that leaves the
// triangle goes on in the neighbour, unfolded into its plane; past the outermost edge of the mesh the last
// triangle is extrapolated.
//
// Measure of success: the sine of the angle between h and n. Roots with h.n <= 0 are no reflections (E and
// Q lie on different sides, or both behind the mirror). World space, double. Sources: Hanika et al. 2015 and
// Zeltner et al. 2020 for the constraint and the choice of roots; Roger & Holzschuch 2006 for J as an
// extremum of path length.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "catoptric/core/math.h"
#include "catoptric/virtual_object/mesh_walk.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// A point on the mirror. (u, v) may lie outside of the triangle only past the outermost edge of the mesh.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  double u = 1.0 / 3, v = 1.0 / 3;
};

/// Two doubles that go through the same arithmetic: (eye, point) in the law, (edge 1, edge 2) in its
/// derivative. Half the instructions of the innermost loop; the compiler does not find the pairs by itself.
using Pair = double __attribute__((vector_size(16)));

struct PairVec3 {
  Pair x, y, z;
};

[[nodiscard]] inline PairVec3 makePair(const dvec3& a, const dvec3& b) {
  return {Pair{a.x, b.x}, Pair{a.y, b.y}, Pair{a.z, b.z}};
}
[[nodiscard]] inline Pair dot(const PairVec3& a, const PairVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Pair dot(const PairVec3& a, const dvec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The mirror law at one point of the mirror. Squares instead of roots, products instead of quotients: this
/// is the innermost loop.
struct MirrorLaw {
  dvec3 position, normal;  ///< normal not unit
  dvec3 toEye, toPoint;    ///< unit
  double distanceEye, distancePoint;
  double inverseEye, inversePoint, inverseSum;  ///< of the distances and of their sum
  double nn, hn;                                ///< n.n and h.n; hn > 0 where E and Q lie in front
  dvec3 h, q;                                   ///< half vector (not unit); q = (n.n) h - (h.n) n
  double qq;                                    ///< q.q

  /// Square of the sine of the angle between half vector and normal; NaN where h = 0.
  [[nodiscard]] double squaredSine() const { return qq / (glm::dot(h, h) * nn * nn); }
  [[nodiscard]] bool isWithin(double sine) const { return qq <= sine * sine * glm::dot(h, h) * nn * nn; }
  /// The ray from the eye to the point goes straight on here, into the mirror, which hides the point. q
  /// vanishes with h, so searches are drawn here.
  static constexpr double kStraight = 1e-4;
  [[nodiscard]] bool isStraight() const { return glm::dot(h, h) < kStraight * kStraight; }
  /// Square of |s q| / (n.n), the merit function of the search, a length squared.
  [[nodiscard]] double squaredMerit() const {
    const double s = distanceEye * distancePoint * inverseSum;
    return s * s * qq / (nn * nn);
  }
};

[[nodiscard]] inline MirrorLaw evaluateMirrorLaw(const MirrorTriangle& t, double u, double v,
                                                 const dvec3& eye, const dvec3& point) {
  MirrorLaw law;
  law.position = t.position(u, v);
  law.normal = t.normal(u, v);
  const dvec3 p = law.position;
  const PairVec3 away{Pair{eye.x, point.x} - p.x, Pair{eye.y, point.y} - p.y, Pair{eye.z, point.z} - p.z};
  const Pair squared = dot(away, away);
  const double a = std::sqrt(squared[0]), b = std::sqrt(squared[1]);
  const double sum = a + b, inverse = 1.0 / (a * b * sum);
  const Pair inverses = Pair{b, a} * (sum * inverse);
  law.distanceEye = a, law.distancePoint = b;
  law.inverseEye = inverses[0], law.inversePoint = inverses[1], law.inverseSum = a * b * inverse;
  const Pair x = away.x * inverses, y = away.y * inverses, z = away.z * inverses;
  law.toEye = {x[0], y[0], z[0]}, law.toPoint = {x[1], y[1], z[1]};
  law.h = law.toEye + law.toPoint;
  law.nn = glm::dot(law.normal, law.normal);
  law.hn = glm::dot(law.h, law.normal);
  law.q = law.nn * law.h - law.hn * law.normal;
  law.qq = glm::dot(law.q, law.q);
  return law;
}

/// Newton's step (du, dv). Not finite where the two equations are dependent.
[[nodiscard]] inline dvec2 computeNewtonStep(const MirrorTriangle& t, const MirrorLaw& law) {
  const dvec3 n = law.normal, h = law.h, q = law.q;
  const dvec3 wi = law.toEye * law.inverseEye, wo = law.toPoint * law.inversePoint;
  const double inverseBoth = law.inverseEye + law.inversePoint;
  const double eyeShare = law.distancePoint * law.inverseSum, pointShare = law.distanceEye * law.inverseSum;
  // Along an edge e with normal change m: dh = (wi (wi.e) - e) / a + (wo (wo.e) - e) / b, and ds / s.
  const PairVec3 e = makePair(t.edge1, t.edge2), m = makePair(t.normal1, t.normal2);
  const Pair ie = dot(e, law.toEye), oe = dot(e, law.toPoint);
  const PairVec3 dh{wi.x * ie + wo.x * oe - e.x * inverseBoth, wi.y * ie + wo.y * oe - e.y * inverseBoth,
                    wi.z * ie + wo.z * oe - e.z * inverseBoth};
  const Pair dNn = 2.0 * dot(m, n), dHn = dot(dh, n) + dot(m, h);
  const Pair dLogS = -(dot(e, wi) * eyeShare + dot(e, wo) * pointShare);
  const PairVec3 dq{dNn * h.x + law.nn * dh.x - dHn * n.x - law.hn * m.x + dLogS * q.x,
                    dNn * h.y + law.nn * dh.y - dHn * n.y - law.hn * m.y + dLogS * q.y,
                    dNn * h.z + law.nn * dh.z - dHn * n.z - law.hn * m.z + dLogS * q.z};
  const Pair f = dot(e, q), j1 = dot(dq, t.edge1), j2 = dot(dq, t.edge2);
  const double inverseDeterminant = 1.0 / (j1[0] * j2[1] - j1[1] * j2[0]);
  return {(j1[1] * f[1] - j2[1] * f[0]) * inverseDeterminant,
          (j2[0] * f[0] - j1[0] * f[1]) * inverseDeterminant};
}

/// Moves a surface point by (du, dv) of its triangle; past the end of the mesh it leaves the last triangle.
inline void walkOnMesh(std::span<const MirrorTriangle> triangles, SurfacePoint& at, double du, double dv) {
  static_cast<void>(walkOverMesh(triangles, at, du, dv, 96));
}

/// Of the damped Newton search, one vertex or eight at a time (lane_search.h).
namespace search_limits {
inline constexpr double kShorter = 0.35;  // of a step that made it worse
inline constexpr double kFarOutside =
    0.5;  // of a triangle past the last edge: the extrapolated mirror is no guide
inline constexpr int kMostStepsOutside = 3;  // there: such a point is far from being reflected
}  // namespace search_limits

struct SearchResult {
  SurfacePoint at;
  MirrorLaw law;
  int steps = 0;
  bool converged = false;  ///< the law holds to the tolerance, with E and Q in front
};

/// Damped Newton search from `at`. `longestStep` bounds each step, world units.
[[nodiscard]] inline SearchResult searchReflectionPoint(std::span<const MirrorTriangle> triangles,
                                                        SurfacePoint at, const dvec3& eye, const dvec3& point,
                                                        int maxSteps, double tolerance, double longestStep) {
  using namespace search_limits;
  constexpr double kLeastDamping = 0.02;
  constexpr double kTouching = 1e-12;  // the point lies on the mirror, where the law has no meaning
  SearchResult result;
  int stepsOutside = 0;
  SurfacePoint lastGood = at;
  dvec2 lastStep(0);
  double lastMerit = 1e300, damping = 1.0;
  for (result.steps = 1;; ++result.steps) {
    const MirrorTriangle& t = triangles[at.triangle];
    result.at = at;
    result.law = evaluateMirrorLaw(t, at.u, at.v, eye, point);
    if (result.law.isWithin(tolerance)) {  // a root on the back side holds the search fast
      result.converged = result.law.hn > 0;
      return result;
    }
    if (result.law.isStraight() || result.steps >= maxSteps ||
        !(result.law.distancePoint > kTouching * result.law.distanceEye))
      return result;
    if (std::min({at.u, at.v, 1.0 - at.u - at.v}) < -kFarOutside && ++stepsOutside > kMostStepsOutside)
      return result;
    const double merit = result.law.squaredMerit();
    dvec2 step;
    if (merit < lastMerit || damping < kLeastDamping) {
      step = computeNewtonStep(t, result.law);
      const dvec3 move = step.x * t.edge1 + step.y * t.edge2;
      const double squared = glm::dot(move, move);
      if (!(squared < 1e300)) return result;
      if (squared > longestStep * longestStep) step *= longestStep / std::sqrt(squared);
      lastGood = at, lastMerit = merit, lastStep = step, damping = 1.0;
    } else {  // worse: back, and not as far
      at = lastGood;
      damping *= kShorter;
      step = lastStep * damping;
    }
    walkOnMesh(triangles, at, step.x, step.y);
  }
}

}  // namespace catoptric::virtual_object
