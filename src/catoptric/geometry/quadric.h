// SPDX-License-Identifier: Apache-2.0
// Is this mesh a piece of a quadric: an ellipsoid, a paraboloid, a hyperboloid, an elliptic cone or cylinder?
//
// Inputs: as shape_recognition.h. Steps:
//   1. ten coefficients of f by linear least squares: f = 0 at the vertices, grad f along their normals
//      (weighted less, for exporters compute normals from facets); f is the eigenvector of the smallest
//      eigenvalue,
//   2. the sign of f, so that grad f points to where the normals do,
//   3. deviation: |f| / |grad f|, the distance to first order, and the angle between normal and gradient.
// Absent where a vertex has no gradient (a cone's apex) or fewer than 10 are given. A nearly flat patch is
// many quadrics to within rounding; one of them is found. Cost: linear in vertices.
// Source: Taubin 1991; Pratt 1987.
#pragma once

#include "catoptric/geometry/implicit_surface.h"

namespace catoptric::geometry {

/// f(p) = x.(a x) + b.x + c with x = (p - origin) / scale; grad f is taken with respect to p.
struct Quadric final : ImplicitSurface {
  dvec3 origin{0};
  double scale = 1;
  dmat3 a{0.0};  ///< symmetric
  dvec3 b{0};
  double c = 0;

  [[nodiscard]] Sample sampleAt(const dvec3& p) const override {
    const dvec3 x = (p - origin) / scale, ax = a * x;
    return {glm::dot(x, ax) + glm::dot(b, x) + c, (2.0 * ax + b) / scale};
  }
  [[nodiscard]] dmat3 hessian(const dvec3& /*p*/) const override { return a * (2.0 / (scale * scale)); }
  /// The same surface with its bright side on the other side.
  [[nodiscard]] Quadric flipped() const {
    Quadric other = *this;
    other.a *= -1.0, other.b *= -1.0, other.c *= -1.0;
    return other;
  }
};

struct QuadricFit {
  Quadric quadric;
  FitDeviation deviation;
};

[[nodiscard]] std::optional<QuadricFit> fitQuadric(const MeshView& mesh);

}  // namespace catoptric::geometry
