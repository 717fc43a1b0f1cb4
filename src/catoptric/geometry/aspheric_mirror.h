// SPDX-License-Identifier: Apache-2.0
// Is this mesh an aspheric mirror, as optics and wing mirrors are specified: the surface of revolution
// z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + a6 r^6 around its axis?
//
// Inputs: as shape_recognition.h; whole mirrors, rings and pieces beside the axis. Steps:
//   1. the axis (revolution_axis.h), two to choose from,
//   2. nine parameters polished on the vertices' distances (implicit_surface.h), from four starts: k = -1 (a
//      paraboloid, in which all is linear) and k = 0, each first with the axis as found, then with the terms
//      in r^4 and r^6 left out; the best of them,
//   3. deviation: distance to first order, and the angle between normal and gradient.
// The equation has a root that ends where the sphere does; w = z - a4 r^4 - a6 r^6 in
// c r^2 - 2 w + (1 + k) c w^2 = 0 has none: a polynomial, smooth everywhere, with the other half of the
// sphere or hyperboloid as a second sheet. Absent for fewer than 12 vertices, and where no axis is found or
// the normals miss it by far. Known failure: quadrics of revolution are aspheric mirrors too; ask
// geometry/quadric.h first. Cost: some 10 to 50 ms. Source: ISO 10110-12; Pottmann & Randrup 1998 for the
// axis.
#pragma once

#include "catoptric/geometry/implicit_surface.h"
#include "catoptric/geometry/revolution_axis.h"

namespace catoptric::geometry {

/// Lengths in the coefficients are in units of `scale`. Bright towards +z of the frame at the apex.
struct AsphericMirror final : ImplicitSurface {
  AxisFrame frame;  ///< origin: the apex
  double scale = 1;
  double curvature = 0;  ///< c; negative: convex seen from the bright side
  double conic = 0;      ///< k
  double a4 = 0, a6 = 0;

  [[nodiscard]] Sample sampleAt(const dvec3& p) const override;
  [[nodiscard]] dmat3 hessian(const dvec3& p) const override;
  [[nodiscard]] bool isOnSheet(const dvec3& p) const override;  ///< the apex's half of the sphere
};

struct AsphericFit {
  AsphericMirror mirror;
  FitDeviation deviation;
};

[[nodiscard]] std::optional<AsphericFit> fitAsphericMirror(const MeshView& mesh);

}  // namespace catoptric::geometry
