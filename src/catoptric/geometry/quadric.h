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

#include "catoptric/geometry/shape_recognition.h"

namespace catoptric::geometry {

/// f(p) = x.(a x) + b.x + c with x = (p - origin) / scale; grad f is taken with respect to p.
struct Quadric {
  dvec3 origin{0};
  double scale = 1;
  dmat3 a{0.0};  ///< symmetric
  dvec3 b{0};
  double c = 0;

  [[nodiscard]] double value(const dvec3& p) const {
    const dvec3 x = (p - origin) / scale;
    return glm::dot(x, a * x) + glm::dot(b, x) + c;
  }
  [[nodiscard]] dvec3 gradient(const dvec3& p) const {
    return (2.0 * (a * ((p - origin) / scale)) + b) / scale;
  }
  [[nodiscard]] dmat3 hessian() const { return a * (2.0 / (scale * scale)); }
  /// The same surface with its bright side on the other side.
  [[nodiscard]] Quadric flipped() const { return {origin, scale, a * -1.0, b * -1.0, -c}; }
  /// The surface's point near a point that is near it, along the gradient.
  [[nodiscard]] dvec3 project(dvec3 p) const {
    for (int i = 0; i < 4; ++i) {
      const dvec3 g = gradient(p);
      p -= g * (value(p) / std::max(glm::dot(g, g), 1e-300));
    }
    return p;
  }
};

struct QuadricFit {
  Quadric quadric;
  FitDeviation deviation;
};

[[nodiscard]] std::optional<QuadricFit> fitQuadric(const MeshView& mesh);

}  // namespace catoptric::geometry
