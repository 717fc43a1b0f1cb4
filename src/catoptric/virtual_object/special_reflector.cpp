// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/special_reflector.h"

#include <cmath>

#include "catoptric/core/polynomial.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kHalfTurn = 3.141592653589793;

/// sin2 sin(2 phi) + cos2 cos(2 phi) + sin1 sin(phi) + cos1 cos(phi)
struct Wave {
  double sin2, cos2, sin1, cos1;

  [[nodiscard]] double at(double phi) const {
    const double s = std::sin(phi), c = std::cos(phi);
    return 2 * sin2 * s * c + cos2 * (c * c - s * s) + sin1 * s + cos1 * c;
  }
  [[nodiscard]] double slopeAt(double phi) const {
    const double s = std::sin(phi), c = std::cos(phi);
    return 2 * (sin2 * (c * c - s * s) - 2 * cos2 * s * c) + sin1 * c - cos1 * s;
  }
};

/// Step 2, from positions across the axis and the radii R of both.
Wave makeWave(const dvec2& e, const dvec2& q, double radiusE, double radiusQ) {
  return {e.x * q.x - e.y * q.y, -(e.x * q.y + e.y * q.x), -(radiusQ * e.x + radiusE * q.x),
          radiusQ * e.y + radiusE * q.y};
}

/// Step 3: the angles at which the wave is zero.
core::RealRoots findZeros(const Wave& wave) {
  double start = 0, farthest = 0;
  for (int i = 0; i < 8; ++i) {
    const double phi = 0.25 * kHalfTurn * i + 0.1, value = std::abs(wave.at(phi));
    if (value > farthest) farthest = value, start = phi;
  }
  if (!(farthest > 0)) return {};
  const double s = std::sin(start), c = std::cos(start), s2 = 2 * s * c, c2 = c * c - s * s;
  const Wave turned{wave.sin2 * c2 - wave.cos2 * s2, wave.sin2 * s2 + wave.cos2 * c2,
                    wave.cos1 * s - wave.sin1 * c, -wave.sin1 * s - wave.cos1 * c};
  const double quartic[5] = {turned.cos2 + turned.cos1, 4 * turned.sin2 + 2 * turned.sin1, -6 * turned.cos2,
                             2 * turned.sin1 - 4 * turned.sin2, turned.cos2 - turned.cos1};
  core::RealRoots roots = core::findRealRoots(quartic);
  for (int i = 0; i < roots.count; ++i) {
    double& phi = roots.values[std::size_t(i)];
    phi = start + kHalfTurn + 2 * std::atan(phi);
    for (int step = 0; step < 2; ++step) {
      const double change = wave.at(phi) / wave.slopeAt(phi);
      if (std::abs(change) < 1e-3) phi -= change;
    }
  }
  return roots;
}

struct Circle {
  dvec2 eye, point;  // in its plane, relative to its centre
  double radius;
};

/// Steps 3 and 4 on a circle: calls add(unit normal outwards) for each reflection.
template <class Add>
void forCircleReflections(const Circle& circle, bool isInside, const Add& add) {
  const Wave wave = makeWave(circle.eye, circle.point, circle.radius, circle.radius);
  for (const double phi : findZeros(wave)) {
    const dvec2 n(std::cos(phi), std::sin(phi));
    const double sign = isInside ? -1 : 1;
    const double e = sign * (glm::dot(n, circle.eye) - circle.radius),
                 q = sign * (glm::dot(n, circle.point) - circle.radius);
    if (e > 0 && q > 0) add(n);
  }
}

/// Any unit vector across the given one.
dvec3 makeAcross(const dvec3& unit) {
  const dvec3 helper = std::abs(unit.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(unit, helper));
}

void findOnPlane(const SpecialReflector& r, const dvec3& eye, const dvec3& point, Reflections& found) {
  const dvec3 n = r.isInside ? -r.axis : r.axis;
  const double e = glm::dot(n, eye - r.origin), q = glm::dot(n, point - r.origin);
  if (!(e > 0 && q > 0)) return;
  found.all[0] = {(q * (eye - e * n) + e * (point - q * n)) / (e + q), n};
  found.count = 1;
}

void findOnSphere(const SpecialReflector& r, const dvec3& eye, const dvec3& point, Reflections& found) {
  const dvec3 e = eye - r.origin, q = point - r.origin;
  const double distance = glm::length(e);
  const dvec3 x = distance > 0 ? e / distance : dvec3(1, 0, 0);
  const dvec3 rest = q - glm::dot(q, x) * x;
  const double across = glm::length(rest);
  const dvec3 y = across > 1e-14 * distance ? rest / across : makeAcross(x);
  const Circle circle{{distance, 0}, {glm::dot(q, x), glm::dot(q, y)}, r.radius};
  forCircleReflections(circle, r.isInside, [&](const dvec2& n2) {
    const dvec3 n = n2.x * x + n2.y * y;
    found.all[std::size_t(found.count++)] = {r.origin + r.radius * n, r.isInside ? -n : n};
  });
}

void findOnCylinder(const SpecialReflector& r, const dvec3& eye, const dvec3& point, Reflections& found) {
  const dvec3 x = makeAcross(r.axis), y = glm::cross(r.axis, x), e = eye - r.origin, q = point - r.origin;
  const Circle circle{{glm::dot(e, x), glm::dot(e, y)}, {glm::dot(q, x), glm::dot(q, y)}, r.radius};
  const double eyeAlong = glm::dot(e, r.axis), pointAlong = glm::dot(q, r.axis);
  forCircleReflections(circle, r.isInside, [&](const dvec2& n2) {
    const dvec2 at = r.radius * n2;
    const double toEye = glm::distance(at, circle.eye), toPoint = glm::distance(at, circle.point);
    const double along = (eyeAlong * toPoint + pointAlong * toEye) / (toEye + toPoint);
    const dvec3 n = n2.x * x + n2.y * y;
    found.all[std::size_t(found.count++)] = {r.origin + r.radius * n + along * r.axis, r.isInside ? -n : n};
  });
}

void findOnCone(const SpecialReflector& r, const dvec3& eye, const dvec3& point, Reflections& found) {
  const dvec3 x = makeAcross(r.axis), y = glm::cross(r.axis, x), e3 = eye - r.origin, q3 = point - r.origin;
  const double sine = std::sin(r.halfAngleRadians), cosine = std::cos(r.halfAngleRadians);
  const double tangent = sine / cosine;
  const Wave wave = makeWave({glm::dot(e3, x), glm::dot(e3, y)}, {glm::dot(q3, x), glm::dot(q3, y)},
                             tangent * glm::dot(e3, r.axis), tangent * glm::dot(q3, r.axis));
  for (const double phi : findZeros(wave)) {
    const dvec3 out = std::cos(phi) * x + std::sin(phi) * y, outward = cosine * out - sine * r.axis;
    const dvec3 n = r.isInside ? -outward : outward, along = cosine * r.axis + sine * out;
    const double e = glm::dot(n, e3), q = glm::dot(n, q3);
    if (!(e > 0 && q > 0)) continue;
    // Unfolded around the line of contact the path is straight. (Dividing as e : q is the same, but loses
    // digits at grazing angles, where both are small.)
    const double eyeAlong = glm::dot(e3, along), pointAlong = glm::dot(q3, along);
    const double toEye = glm::length(e3 - eyeAlong * along), toPoint = glm::length(q3 - pointAlong * along);
    const double fromApex = (toPoint * eyeAlong + toEye * pointAlong) / (toEye + toPoint);
    if (fromApex > 0) found.all[std::size_t(found.count++)] = {r.origin + fromApex * along, n};
  }
}

}  // namespace

Reflections findReflections(const SpecialReflector& reflector, const dvec3& eye, const dvec3& point) {
  Reflections found;
  switch (reflector.shape) {
    case SpecialShape::Plane:
      findOnPlane(reflector, eye, point, found);
      break;
    case SpecialShape::Sphere:
      findOnSphere(reflector, eye, point, found);
      break;
    case SpecialShape::Cylinder:
      findOnCylinder(reflector, eye, point, found);
      break;
    case SpecialShape::Cone:
      findOnCone(reflector, eye, point, found);
      break;
  }
  return found;
}

}  // namespace catoptric::virtual_object
