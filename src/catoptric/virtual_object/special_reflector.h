// SPDX-License-Identifier: Apache-2.0
// Where does the eye E see the point Q in a sphere, a cylinder, a cone or a plane? All answers, in closed
// form.
//
// World space, double. Let e and q be the distances of E and Q from the tangent plane at J. Mirroring says
// that J divides the feet of E and Q on that plane as e : q, that is, t.E q + t.Q e = 0 for every tangent t.
//   1. Sphere: E, Q, J and the centre lie in one plane; there the sphere is a circle. Cylinder: across the
//      axis it is a circle, and along the axis the path is straight. Cone: all tangent planes hold the apex
//      and J lies on the line of contact of one, so only t across that line is left.
//   2. All three come down to one angle phi around the centre or axis:
//        rE rQ sin(2 phi - phiE - phiQ) = RQ rE sin(phi - phiE) + RE rQ sin(phi - phiQ),
//      r the distance from the axis; RE = RQ = R on a sphere or cylinder (Alhazen's problem), R = tan(alpha)
//      times the distance along the axis from the apex on a cone of half angle alpha.
//   3. With u = tan(psi / 2), psi counted from where the left side minus the right is farthest from zero: a
//      quartic with a leading coefficient that is never small. All real roots by core/polynomial.h, each
//      polished on the trigonometric equation.
//   4. Roots with E and Q in front of the tangent plane, on the bright side, are reflections.
// Outside a convex shape there is exactly one (or none when the shape hides Q); inside up to four.
//
// Departures: the 1998 paper leaves the formulas to Ofek's thesis; these are our own, one quartic for all.
// Known failures: E and Q on one line through the centre or on the axis have a whole circle of answers, of
// which the ones in one plane (or none) are returned; double roots (Q on a caustic) may be left out. Cost:
// about 2 us. Source: Ofek & Rappoport 1998, section 5; Alhazen's quartic after Agrawal et al. 2011.
#pragma once

#include <array>
#include <cstdint>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

enum class SpecialShape : std::uint8_t { Plane, Sphere, Cylinder, Cone };

struct SpecialReflector {
  SpecialShape shape = SpecialShape::Sphere;
  dvec3 origin{0};      ///< centre, a point of the axis, the apex, or a point of the plane
  dvec3 axis{0, 0, 1};  ///< unit; a cone's points from the apex into the nappe; a plane's is its normal
  double radius = 1;    ///< sphere, cylinder
  double halfAngleRadians = 0;  ///< cone
  bool isInside = false;        ///< the bright side is the inner one
};

struct Reflection {
  dvec3 position{0}, normal{0, 0, 1};  ///< normal: unit, towards the bright side
};

struct Reflections {
  std::array<Reflection, 4> all;
  int count = 0;

  [[nodiscard]] const Reflection* begin() const { return all.data(); }
  [[nodiscard]] const Reflection* end() const { return all.data() + count; }
};

/// All of them, on the whole (unbounded) shape.
[[nodiscard]] Reflections findReflections(const SpecialReflector& reflector, const dvec3& eye,
                                          const dvec3& point);

}  // namespace catoptric::virtual_object
