// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/shape_recognition.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/symmetric_eigen.h"

namespace catoptric::geometry {
namespace {

dvec3 meanOf(std::span<const vec3> points) {
  dvec3 sum(0);
  for (const vec3& p : points) sum += dvec3(p);
  return points.empty() ? sum : sum / double(points.size());
}

dmat3 covarianceOf(std::span<const vec3> points, const dvec3& centre) {
  dmat3 sum(0.0);
  for (const vec3& point : points) {
    const dvec3 d = dvec3(point) - centre;
    sum += glm::outerProduct(d, d);
  }
  return sum / double(std::max<std::size_t>(points.size(), 1));
}

/// Solves a x = b for symmetric positive a; absent where a is (nearly) singular.
std::optional<dvec3> solveSymmetric(const dmat3& a, const dvec3& b, double minimumCondition) {
  const Eigen3 eigen = computeEigen(a);
  if (!(eigen.values[0] > minimumCondition * eigen.values[2]) || !(eigen.values[2] > 0)) return std::nullopt;
  dvec3 x(0);
  for (int i = 0; i < 3; ++i) x += eigen.vectors[i] * (glm::dot(eigen.vectors[i], b) / eigen.values[i]);
  return x;
}

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Step 3, for any shape given by its signed distance and outward normal at a point.
template <class Distance, class Normal>
FitDeviation measureDeviation(const MeshView& mesh, bool isInside, const Distance& distance,
                              const Normal& normal) {
  FitDeviation deviation;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p(mesh.positions[i]), n(mesh.normals[i]);
    deviation.distance = std::max(deviation.distance, std::abs(distance(p)));
    const double angle = angleBetween(n, isInside ? -normal(p) : normal(p));
    deviation.angleRadians = std::max(deviation.angleRadians, angle);
  }
  return deviation;
}

template <class Normal>
bool facesInside(const MeshView& mesh, const Normal& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    sum += glm::dot(dvec3(mesh.normals[i]), normal(dvec3(mesh.positions[i])));
  return sum < 0;
}

/// |p - c|^2 = r^2 is linear in c and r^2 - |c|^2. `weight` removes the axis for a circle (0) or nothing (1).
/// The positions are taken relative to `origin`; `project` maps them into the plane of a circle.
std::optional<dvec3> fitCentre(const MeshView& mesh, const dvec3& origin, const dmat3& project,
                               double minCondition, const dmat3& regular) {
  dvec3 meanPoint(0);
  double meanSquare = 0;
  const double count = double(mesh.positions.size());
  for (const vec3& position : mesh.positions) {
    const dvec3 p = project * (dvec3(position) - origin);
    meanPoint += p / count;
    meanSquare += glm::dot(p, p) / count;
  }
  dmat3 a(0.0);
  dvec3 b(0);
  for (const vec3& position : mesh.positions) {
    const dvec3 p = project * (dvec3(position) - origin), d = p - meanPoint;
    a += glm::outerProduct(d, d) / count;
    b += d * (0.5 * (glm::dot(p, p) - meanSquare) / count);
  }
  const double scale = a[0][0] + a[1][1] + a[2][2];
  return solveSymmetric(a + regular * scale, b, minCondition);
}

}  // namespace

std::optional<PlaneFit> fitPlane(const MeshView& mesh) {
  if (mesh.positions.empty()) return std::nullopt;
  const dvec3 origin(mesh.positions[0]);
  dvec3 areaNormal(0), moment(0);
  double area = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3 a = dvec3(mesh.positions[mesh.indices[i]]) - origin;
    const dvec3 b = dvec3(mesh.positions[mesh.indices[i + 1]]) - origin;
    const dvec3 c = dvec3(mesh.positions[mesh.indices[i + 2]]) - origin;
    const dvec3 n = glm::cross(b - a, c - a);
    const double weight = glm::length(n);
    areaNormal += n;
    moment += weight * (a + b + c) / 3.0;
    area += weight;
  }
  const double length = glm::length(areaNormal);
  if (!(length > 1e-6 * area)) return std::nullopt;  // closed, or folded onto itself
  PlaneFit fit;
  fit.plane.normal = areaNormal / length;
  fit.plane.offset = -glm::dot(fit.plane.normal, origin + moment / area);
  const auto normal = [&](const dvec3&) { return fit.plane.normal; };
  const bool isInside = facesInside(mesh, normal);
  const auto distance = [&](const dvec3& p) { return fit.plane.signedDistance(p); };
  fit.deviation = measureDeviation(mesh, isInside, distance, normal);
  return fit;
}

std::optional<SphereFit> fitSphere(const MeshView& mesh) {
  if (mesh.positions.size() < 4) return std::nullopt;
  // 1. Algebraic fit.
  const dvec3 origin = meanOf(mesh.positions);
  const auto centre = fitCentre(mesh, origin, dmat3(1.0), 1e-9, dmat3(0.0));
  if (!centre) return std::nullopt;
  SphereFit fit;
  fit.centre = origin + *centre;
  // 2. Gauss-Newton on the distances: the radius is their mean.
  for (int step = 0; step < 4; ++step) {
    dvec3 gradientMean(0);
    double distanceMean = 0;
    const double count = double(mesh.positions.size());
    for (const vec3& position : mesh.positions) {
      const dvec3 d = dvec3(position) - fit.centre;
      const double r = std::max(glm::length(d), 1e-300);
      gradientMean += d / r / count;
      distanceMean += r / count;
    }
    dmat3 a(0.0);
    dvec3 b(0);
    for (const vec3& position : mesh.positions) {
      const dvec3 d = dvec3(position) - fit.centre;
      const double r = std::max(glm::length(d), 1e-300);
      const dvec3 g = d / r - gradientMean;
      a += glm::outerProduct(g, g) / count;
      b += g * ((r - distanceMean) / count);
    }
    fit.radius = distanceMean;
    const auto move = solveSymmetric(a, b, 1e-9);
    if (!move) break;
    fit.centre += *move;
    if (glm::length(*move) < 1e-14 * fit.radius) break;
  }
  // 3.
  const auto normal = [&](const dvec3& p) {
    const double r = glm::length(p - fit.centre);
    return r > 0 ? (p - fit.centre) / r : dvec3(0, 0, 1);
  };
  fit.isInside = facesInside(mesh, normal);
  fit.deviation = measureDeviation(
      mesh, fit.isInside, [&](const dvec3& p) { return glm::length(p - fit.centre) - fit.radius; }, normal);
  return fit;
}

std::optional<CylinderFit> fitCylinder(const MeshView& mesh) {
  if (mesh.positions.size() < 6) return std::nullopt;
  // 1. All normals are perpendicular to the axis; in the plane across it the vertices lie on a circle.
  const Eigen3 gauss = computeEigen(covarianceOf(mesh.normals, dvec3(0)));
  if (gauss.values[1] < 1e-6 * gauss.values[2]) return std::nullopt;  // one normal: a plane
  CylinderFit fit;
  fit.axis = gauss.vectors[0];
  const dmat3 along = glm::outerProduct(fit.axis, fit.axis), across = dmat3(1.0) - along;
  const dvec3 origin = meanOf(mesh.positions);
  const auto centre = fitCentre(mesh, origin, across, 1e-9, along);
  if (!centre) return std::nullopt;
  fit.point = origin + across * *centre;
  const auto radial = [&](const dvec3& p) { return across * (p - fit.point); };
  // 2. The mean distance is the best radius for this axis.
  for (const vec3& p : mesh.positions)
    fit.radius += glm::length(radial(dvec3(p))) / double(mesh.positions.size());
  // 3.
  const auto normal = [&](const dvec3& p) {
    const dvec3 d = radial(p);
    const double r = glm::length(d);
    return r > 0 ? d / r : dvec3(0, 0, 1);
  };
  fit.isInside = facesInside(mesh, normal);
  fit.deviation = measureDeviation(
      mesh, fit.isInside, [&](const dvec3& p) { return glm::length(radial(p)) - fit.radius; }, normal);
  return fit;
}

std::optional<ConeFit> fitCone(const MeshView& mesh) {
  if (mesh.positions.size() < 6) return std::nullopt;
  // 1. The normals make one angle with the axis: their tips lie in a plane across it. Every tangent plane
  // holds the apex.
  const Eigen3 gauss = computeEigen(covarianceOf(mesh.normals, meanOf(mesh.normals)));
  if (gauss.values[1] < 1e-6 * gauss.values[2]) return std::nullopt;
  ConeFit fit;
  fit.axis = gauss.vectors[0];
  const dvec3 origin = meanOf(mesh.positions);
  dmat3 a(0.0);
  dvec3 b(0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 n(mesh.normals[i]);
    a += glm::outerProduct(n, n);
    b += n * glm::dot(n, dvec3(mesh.positions[i]) - origin);
  }
  const auto apex = solveSymmetric(a, b, 1e-7);
  if (!apex) return std::nullopt;
  fit.apex = origin + *apex;
  if (glm::dot(fit.axis, origin - fit.apex) < 0) fit.axis = -fit.axis;
  const double sine = glm::dot(meanOf(mesh.normals), fit.axis);
  fit.halfAngleRadians = std::asin(std::clamp(std::abs(sine), 0.0, 1.0));
  // 3. Distance to the generator line in the half-plane through the axis.
  const double sinHalf = std::sin(fit.halfAngleRadians), cosHalf = std::cos(fit.halfAngleRadians);
  const auto normal = [&](const dvec3& p) {
    const dvec3 d = p - fit.apex, radial = d - fit.axis * glm::dot(fit.axis, d);
    const double r = glm::length(radial);
    return r > 0 ? radial * (cosHalf / r) - fit.axis * sinHalf : -fit.axis;
  };
  const auto distance = [&](const dvec3& p) {
    const dvec3 d = p - fit.apex;
    const double t = glm::dot(fit.axis, d), r = glm::length(d - fit.axis * t);
    return r * cosHalf - t * sinHalf;
  };
  fit.isInside = facesInside(mesh, normal);
  fit.deviation = measureDeviation(mesh, fit.isInside, distance, normal);
  return fit;
}

}  // namespace catoptric::geometry
