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
// Measure of success: the sine of the angle between h and n. Roots with lambda <= 0 are no reflections (E and
// Q lie on different sides, or both behind the mirror). World space, double. Sources: Hanika et al. 2015 and
// Zeltner et al. 2020 for the constraint and the choice of roots; Roger & Holzschuch 2006 for J as an
// extremum of path length.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "catoptric/core/math.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// A point on the mirror. (u, v) may lie outside of the triangle only past the outermost edge of the mesh.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  double u = 1.0 / 3, v = 1.0 / 3;
};

/// The mirror law at one point of the mirror.
struct MirrorLaw {
  dvec3 position, normal;  ///< normal not unit
  dvec3 toEye, toPoint;    ///< unit
  double distanceEye, distancePoint;
  double lambda;  ///< positive where E and Q lie in front
  double sine;    ///< residual: of the angle between half vector and normal
  double across;  ///< |s q|, the merit function of the search, a length
  double du, dv;  ///< Newton's step
};

/// Evaluates the law and Newton's step. Where the two equations are dependent the step is not finite.
[[nodiscard]] inline MirrorLaw evaluateMirrorLaw(const MirrorTriangle& t, double u, double v,
                                                 const dvec3& eye, const dvec3& point) {
  MirrorLaw law;
  law.position = t.position(u, v);
  law.normal = t.normal(u, v);
  const dvec3 n = law.normal;
  const dvec3 toEye = eye - law.position, toPoint = point - law.position;
  const double a = std::sqrt(glm::dot(toEye, toEye)), b = std::sqrt(glm::dot(toPoint, toPoint));
  const double inverseA = 1.0 / a, inverseB = 1.0 / b;
  const dvec3 wi = toEye * inverseA, wo = toPoint * inverseB;
  law.toEye = wi, law.toPoint = wo;
  law.distanceEye = a, law.distancePoint = b;

  const dvec3 h = wi + wo;
  const double inverseNn = 1.0 / glm::dot(n, n);
  const double lambda = glm::dot(h, n) * inverseNn;
  const dvec3 q = h - lambda * n;
  const double qq = glm::dot(q, q), hh = glm::dot(h, h);
  const double inverseSum = 1.0 / (a + b), s = a * b * inverseSum;
  law.lambda = lambda;
  law.sine = std::sqrt(qq / hh);
  law.across = s * std::sqrt(qq);

  // Derivatives along an edge e with normal change m: dh = -(e - wi(wi.e))/a - (e - wo(wo.e))/b.
  const double inverseAPlusB = inverseA + inverseB, ba = b * inverseA * inverseSum,
               ab = a * inverseB * inverseSum;
  const auto differentiate = [&](const dvec3& e, const dvec3& m) {
    const double ie = glm::dot(wi, e), oe = glm::dot(wo, e);
    const dvec3 dh = wi * (ie * inverseA) + wo * (oe * inverseB) - e * inverseAPlusB;
    const double dLambda = (glm::dot(dh, n) + glm::dot(h, m) - 2.0 * lambda * glm::dot(n, m)) * inverseNn;
    const double dLogS = -(ba * ie + ab * oe);
    return dh - lambda * m - dLambda * n + dLogS * q;
  };
  const dvec3 qu = differentiate(t.edge1, t.normal1), qv = differentiate(t.edge2, t.normal2);
  const double f1 = glm::dot(t.edge1, q), f2 = glm::dot(t.edge2, q);
  const double j11 = glm::dot(t.edge1, qu), j12 = glm::dot(t.edge1, qv);
  const double j21 = glm::dot(t.edge2, qu), j22 = glm::dot(t.edge2, qv);
  const double inverseDeterminant = 1.0 / (j11 * j22 - j12 * j21);
  law.du = (j12 * f2 - j22 * f1) * inverseDeterminant;
  law.dv = (j21 * f1 - j11 * f2) * inverseDeterminant;
  return law;
}

/// Moves a surface point by (du, dv) of its triangle, across edges as they come.
inline void walkOnMesh(std::span<const MirrorTriangle> triangles, SurfacePoint& at, double du, double dv) {
  constexpr int kMaxCrossings = 96;
  constexpr int kNoEdge = 3;
  int entered = kNoEdge;
  for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
    const MirrorTriangle& t = triangles[at.triangle];
    // Never straight back over the edge it came in by.
    if (entered == 0 && dv < 0) dv = 0;
    if (entered == 2 && du < 0) du = 0;
    if (entered == 1 && du + dv > 0) du = dv = 0.5 * (du - dv), dv = -dv;
    const double u = at.u + du, v = at.v + dv;
    if (u >= 0 && v >= 0 && u + v <= 1) {
      at.u = u, at.v = v;
      return;
    }
    // The first edge crossed that has a neighbour: edge 0 is v = 0, edge 1 is u + v = 1, edge 2 is u = 0.
    int edge = kNoEdge;
    double first = 2.0;
    const auto consider = [&](int k, double inside, double change) {
      if (inside + change >= 0 || t.neighbours[k] == kNoNeighbour) return;
      const double fraction = change < 0 ? std::max(inside / -change, 0.0) : 0.0;
      if (fraction < first) first = fraction, edge = k;
    };
    consider(0, at.v, dv);
    consider(1, 1.0 - at.u - at.v, -(du + dv));
    consider(2, at.u, du);
    if (edge == kNoEdge) {  // past the end of the mesh
      at.u = u, at.v = v;
      return;
    }
    const double cu = at.u + first * du, cv = at.v + first * dv;
    const double along = edge == 0 ? cu : edge == 1 ? cv : 1.0 - cv;
    const dvec3 rest = (1.0 - first) * (du * t.edge1 + dv * t.edge2);
    const std::uint32_t link = t.neighbours[edge];
    const MirrorTriangle& next = triangles[link / 4];
    entered = int(link % 4);
    const double back = 1.0 - along;
    at.triangle = link / 4;
    at.u = entered == 0 ? back : entered == 1 ? 1.0 - back : 0.0;
    at.v = entered == 0 ? 0.0 : entered == 1 ? back : 1.0 - back;
    const double x = glm::dot(next.edge1, rest), y = glm::dot(next.edge2, rest);
    du = next.gram11 * x + next.gram12 * y;
    dv = next.gram12 * x + next.gram22 * y;
  }
}

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
  SearchResult result;
  SurfacePoint lastGood = at;
  double lastAcross = 1e300, damping = 1.0, lastDu = 0, lastDv = 0;
  for (result.steps = 1; result.steps <= maxSteps; ++result.steps) {
    result.at = at;
    result.law = evaluateMirrorLaw(triangles[at.triangle], at.u, at.v, eye, point);
    const MirrorLaw& law = result.law;
    if (law.sine <= tolerance && law.lambda > 0) {
      result.converged = true;
      return result;
    }
    double du, dv;
    if (law.across < lastAcross || damping < 0.02) {
      const MirrorTriangle& t = triangles[at.triangle];
      du = law.du, dv = law.dv;
      const dvec3 step = du * t.edge1 + dv * t.edge2;
      const double squared = glm::dot(step, step);
      if (!(squared < 1e300)) return result;
      if (squared > longestStep * longestStep) {
        const double shorter = longestStep / std::sqrt(squared);
        du *= shorter, dv *= shorter;
      }
      lastGood = at, lastAcross = law.across, lastDu = du, lastDv = dv, damping = 1.0;
    } else {  // worse: back, and half as far
      at = lastGood;
      damping *= 0.35;
      du = lastDu * damping, dv = lastDv * damping;
    }
    walkOnMesh(triangles, at, du, dv);
  }
  return result;
}

}  // namespace catoptric::virtual_object
