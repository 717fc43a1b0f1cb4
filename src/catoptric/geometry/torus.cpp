// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/torus.h"

#include <cmath>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kFewestVertices = 8;

struct Profile {
  double radius, height, tube;  // the circle's centre, from the axis and along it, and its radius
};

/// Step 1: |p|^2 = 2 p.c + r^2 - |c|^2 is linear. Relative to the mean, so that two unknowns are left.
std::optional<Profile> fitProfile(const MeshView& mesh, const AxisFrame& frame) {
  std::vector<dvec2> points;
  dvec2 mean(0);
  for (const vec3& position : mesh.positions) {
    const dvec3 x = frame.toLocal(dvec3(position));
    points.emplace_back(std::hypot(x.x, x.y), x.z);
    mean += points.back() / double(mesh.positions.size());
  }
  glm::dmat2 a(0.0);
  dvec2 b(0);
  double square = 0;
  for (const dvec2& p : points) {
    const dvec2 d = p - mean;
    a += glm::outerProduct(d, d);
    b += 0.5 * d * glm::dot(d, d);
    square += glm::dot(d, d) / double(points.size());
  }
  const double determinant = glm::determinant(a), trace = a[0][0] + a[1][1];
  if (!(determinant > 1e-9 * trace * trace)) return std::nullopt;
  const dvec2 centre = glm::inverse(a) * b;
  const dvec2 at = mean + centre;
  return Profile{at.x, at.y, std::sqrt(square + glm::dot(centre, centre))};
}

Torus makeTorus(const AxisFrame& frame, double scale, std::span<const double> p) {
  Torus torus;
  torus.frame = frame.moved({p[0], p[1]}, scale * dvec3(p[2], p[3], p[4]));
  torus.majorRadius = std::abs(p[5]) * scale;
  torus.minorRadius = std::abs(p[6]) * scale;
  return torus;
}

/// Sheet by the vertices and bright side by the normals, then step 3.
std::optional<TorusFit> measureTorus(Torus torus, const MeshView& mesh) {
  double along = 0;
  std::size_t onSpindle = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p(mesh.positions[i]);
    along += glm::dot(dvec3(mesh.normals[i]), torus.gradient(p));
    onSpindle += torus.isOnSheet(p) ? 0 : 1;
  }
  torus.isInside = along < 0;
  torus.isSpindle = 2 * onSpindle > mesh.positions.size();
  const auto deviation = measureDeviation(torus, mesh);
  if (!deviation) return std::nullopt;
  return TorusFit{torus, *deviation};
}

}  // namespace

ImplicitSurface::Sample Torus::sampleAt(const dvec3& p) const {
  const dvec3 x = frame.toLocal(p);
  const double ring = majorRadius * majorRadius, sum = glm::dot(x, x) + ring - minorRadius * minorRadius,
               u = x.x * x.x + x.y * x.y, sign = isInside ? -1 : 1;
  const dvec3 local = 4 * sum * x - 8 * ring * dvec3(x.x, x.y, 0);
  return {sign * (sum * sum - 4 * ring * u), sign * (frame.axes * local)};
}

dmat3 Torus::hessian(const dvec3& p) const {
  const dvec3 x = frame.toLocal(p);
  const double ring = majorRadius * majorRadius, sum = glm::dot(x, x) + ring - minorRadius * minorRadius;
  dmat3 h = 8.0 * glm::outerProduct(x, x) + dmat3(4 * sum);
  h[0][0] -= 8 * ring;
  h[1][1] -= 8 * ring;
  return (isInside ? -1.0 : 1.0) * (frame.axes * h * glm::transpose(frame.axes));
}

bool Torus::isOnSheet(const dvec3& p) const {
  // |x|^2 + R^2 - r^2 is 2 R times the distance from the axis, less than zero on the spindle.
  const dvec3 x = frame.toLocal(p);
  return (glm::dot(x, x) + majorRadius * majorRadius < minorRadius * minorRadius) == isSpindle;
}

std::optional<TorusFit> fitTorus(const MeshView& mesh) {
  if (mesh.positions.size() < kFewestVertices) return std::nullopt;
  const double scale = measureScale(mesh).size;
  std::optional<TorusFit> best;
  double bestSquare = 0;
  for (const AxisFrame& frame : findRevolutionAxes(mesh)) {
    const auto profile = fitProfile(mesh, frame);
    if (!profile) continue;
    // 2
    const auto polished = polishSurface(
        [&](std::span<const double> p) { return std::make_unique<Torus>(makeTorus(frame, scale, p)); },
        {0, 0, 0, 0, profile->height / scale, profile->radius / scale, profile->tube / scale},
        mesh.positions);
    if (!polished || (best && !(polished->meanSquare < bestSquare))) continue;
    if (const auto fit = measureTorus(makeTorus(frame, scale, polished->parameters), mesh)) {
      best = fit;
      bestSquare = polished->meanSquare;
      if (polished->isExact) break;
    }
  }
  return best;
}

}  // namespace catoptric::geometry
