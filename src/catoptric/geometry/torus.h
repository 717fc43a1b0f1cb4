// SPDX-License-Identifier: Apache-2.0
// Is this mesh a torus or a piece of one: a ring, a barrel, a toric mirror of two radii?
//
// Inputs: as shape_recognition.h. Steps:
//   1. the axis (revolution_axis.h); in the half plane beside it the vertices lie on a circle, by linear
//      least squares,
//   2. seven parameters polished on the vertices' distances (implicit_surface.h),
//   3. deviation: distance to first order, and the angle between normal and gradient.
// The circle may reach across the axis (a spindle): then its other part, mirrored, is a second sheet.
// Absent for fewer than 8 vertices, without an axis, and where a vertex lies in the axis' own points of a
// spindle. Known failure: spheres are tori too; ask geometry/shape_recognition.h first. Cost: some 10 ms.
// Source: Pottmann & Randrup 1998; Kasa 1976 for the circle.
#pragma once

#include "catoptric/geometry/implicit_surface.h"
#include "catoptric/geometry/revolution_axis.h"

namespace catoptric::geometry {

/// f = (|x|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2), x in the frame.
struct Torus final : ImplicitSurface {
  AxisFrame frame;                             ///< origin: the centre
  double majorRadius = 1, minorRadius = 0.25;  ///< R and r
  bool isSpindle = false;                      ///< the circle's part beyond the axis is meant, where R < r
  bool isInside = false;                       ///< bright where f is negative

  [[nodiscard]] Sample sampleAt(const dvec3& p) const override;
  [[nodiscard]] dmat3 hessian(const dvec3& p) const override;
  [[nodiscard]] bool isOnSheet(const dvec3& p) const override;
};

struct TorusFit {
  Torus torus;
  FitDeviation deviation;
};

[[nodiscard]] std::optional<TorusFit> fitTorus(const MeshView& mesh);

}  // namespace catoptric::geometry
