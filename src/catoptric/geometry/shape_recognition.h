// SPDX-License-Identifier: Apache-2.0
// Is this mesh a plane, a sphere, a cylinder or a cone?
//
// Inputs: vertices of a triangle mesh, their unit normals and the triangles, any frame. Each fit
//   1. solves for the shape by linear least squares on normals and positions (no starting value needed),
//   2. sphere and cylinder: polishes the radius and centre on the distances themselves,
//   3. measures the largest distance of a vertex from the shape and the largest angle between a vertex
//      normal and the shape's.
// The caller compares the two with tolerances of its own. A fit is absent only where the system is singular
// (a flat mesh has no sphere). Normals may all point to the other side: then the surface is the inner one
// (isInside).
//
// Known failures: a sphere or cone that only shows a sliver is ill-conditioned and shows it by its deviation;
// vertices on the shape do not say how far the triangles' interiors leave it. Cost: linear in vertices.
// Source: algebraic fits after Pratt 1987 ("Direct least-squares fitting of algebraic surfaces"); axes from
// the Gauss image of the normals.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

/// A view of a triangle mesh. Normals are unit and as many as positions.
struct MeshView {
  std::span<const vec3> positions;
  std::span<const vec3> normals;
  std::span<const std::uint32_t> indices;
};

struct FitDeviation {
  double distance = 0;      ///< largest distance of a vertex from the shape
  double angleRadians = 0;  ///< largest angle between a vertex normal and the shape's
};

struct PlaneFit {
  core::Plane plane;  ///< normal by the triangles' winding, weighted by area
  FitDeviation deviation;
};
struct SphereFit {
  dvec3 centre{0};
  double radius = 0;
  bool isInside = false;
  FitDeviation deviation;
};
struct CylinderFit {
  dvec3 point{0}, axis{0, 0, 1};  ///< a point on the axis, its unit direction
  double radius = 0;
  bool isInside = false;
  FitDeviation deviation;
};
struct ConeFit {
  dvec3 apex{0}, axis{0, 0, 1};  ///< axis points from the apex into the nappe that the vertices lie on
  double halfAngleRadians = 0;
  bool isInside = false;
  FitDeviation deviation;
};

[[nodiscard]] std::optional<PlaneFit> fitPlane(const MeshView& mesh);
[[nodiscard]] std::optional<SphereFit> fitSphere(const MeshView& mesh);
[[nodiscard]] std::optional<CylinderFit> fitCylinder(const MeshView& mesh);
[[nodiscard]] std::optional<ConeFit> fitCone(const MeshView& mesh);

}  // namespace catoptric::geometry
