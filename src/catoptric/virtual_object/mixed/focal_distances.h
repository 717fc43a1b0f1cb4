// SPDX-License-Identifier: Apache-2.0
// Where the rays that a mirror reflects to an eye come to a focus (methods.md, section 1, "When is one
// virtual object enough?").
//
// X(u, v, t) = J + t r over a mirror triangle: det[J_u + t r_u, J_v + t r_v, r] is a quadratic in the
// distance t; its positive roots are the focal distances along the triangle's reflected ray. World space.
// Cost: about 0.1 us. Source: methods.md; focal distances as of any two-parameter family of rays.
#pragma once

#include <array>

#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

[[nodiscard]] dvec3 reflectAt(const MirrorTriangle& triangle, double u, double v, const dvec3& eye);

/// The rays that leave a mirror triangle around a point of it, as X = J + t r: the area that they go through,
/// for the parallelogram of the triangle's edges, is a quadratic in the distance t.
struct Pencil {
  double c0 = 0, c1 = 0, c2 = 0;
  [[nodiscard]] double areaAt(double t) const { return c0 + t * (c1 + t * c2); }  ///< signed
};
[[nodiscard]] Pencil findPencil(const MirrorTriangle& triangle, const dvec3& eye, double u = 1.0 / 3,
                                double v = 1.0 / 3);

/// Distances at which the rays reflected by a triangle, at (u, v) of it, come to a focus; ascending, infinite
/// where there is none.
[[nodiscard]] std::array<double, 2> findFocalDistances(const MirrorTriangle& triangle, const dvec3& eye,
                                                       double u = 1.0 / 3, double v = 1.0 / 3);

/// Intervals of distance by the number of foci before: regions A, between and B of a hollow, two of a saddle,
/// one of what is convex.
inline constexpr std::size_t kIntervals = 3;

/// Of the triangle's ray that leaves at (1/3, 1/3): to which (u, v) would one have to go, to first order, for
/// the ray to pass through a point? Not finite at a focus.
[[nodiscard]] dvec2 predictPlace(const MirrorTriangle& triangle, const dvec3& eye, const dvec3& point);

/// In which interval a point at a distance along the ray at (u, v) lies.
[[nodiscard]] std::size_t findInterval(const MirrorTriangle& triangle, const dvec3& eye, double u, double v,
                                       double distance);

}  // namespace catoptric::virtual_object
