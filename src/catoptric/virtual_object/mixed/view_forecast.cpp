// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/view_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kSamples = 200;  // of a part, at most
constexpr double kNearFocus = 0.25;    // of the focal distance
constexpr double kStart = 1e-4;        // of the mirror's radius: a ray does not meet where it starts
constexpr double kPartMs = 4.0, kMirrorTriangleMs = 6e-4, kConvexVertexMs = 2.5e-4, kOtherVertexMs = 8e-4,
                 kBoundPixelMs = 5.0e-4;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

double determinant(const dvec3& a, const dvec3& b, const dvec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

dvec3 reflectAt(const MirrorTriangle& t, double u, double v, const dvec3& eye) {
  return core::reflectDirection(glm::normalize(t.position(u, v) - eye), glm::normalize(t.normal(u, v)));
}

enum class Fate : std::uint8_t { Before, Between, Beyond, NearFocus, Self };

/// Steps 2 to 4 for one triangle.
Fate findFate(const MirrorTriangle& t, double radius, const SceneRays& scene, const dvec3& eye) {
  const std::array<double, 2> focal = findFocalDistances(t, eye);
  const dvec3 origin = t.position(1.0 / 3, 1.0 / 3);
  const auto hit =
      geometry::findNearestHit(scene.triangles, origin, reflectAt(t, 1.0 / 3, 1.0 / 3, eye), kStart * radius);
  if (hit && scene.parts[hit->triangle] == scene.ownPart) return Fate::Self;
  const double distance = hit ? hit->distance : kInfinite;
  for (const double f : focal)
    if (std::isfinite(f) && std::abs(distance - f) < kNearFocus * f) return Fate::NearFocus;
  return Fate((focal[0] < distance ? 1 : 0) + (focal[1] < distance ? 1 : 0));
}

}  // namespace

Pencil findPencil(const MirrorTriangle& t, const dvec3& eye, double u, double v) {
  const dvec3 r0 = reflectAt(t, 0, 0, eye), d1 = reflectAt(t, 1, 0, eye) - r0,
              d2 = reflectAt(t, 0, 1, eye) - r0;
  const dvec3 r = r0 + u * d1 + v * d2;
  return {determinant(t.edge1, t.edge2, r), determinant(d1, t.edge2, r) + determinant(t.edge1, d2, r),
          determinant(d1, d2, r)};
}

std::array<double, 2> findFocalDistances(const MirrorTriangle& t, const dvec3& eye) {
  const auto [c0, c1, c2] = findPencil(t, eye);
  std::array<double, 2> roots{kInfinite, kInfinite};
  const double discriminant = c1 * c1 - 4.0 * c0 * c2;
  if (discriminant < 0) return roots;
  // Without cancellation: q / c2 and c0 / q; the first is infinite where the quadratic is a line.
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
  for (const double root : {q / c2, c0 / q})
    if (root > 0 && std::isfinite(root)) (roots[0] == kInfinite ? roots[0] : roots[1]) = root;
  std::sort(roots.begin(), roots.end());
  return roots;
}

std::vector<PartForecast> forecastView(std::span<const MirrorPart* const> parts, const SceneRays& scene,
                                       const dvec3& eye, double pixelsPerTangent) {
  std::vector<PartForecast> forecasts;
  for (const MirrorPart* part : parts) {
    const ReflectorMesh& mesh = *part->mesh;
    const std::size_t step = std::max<std::size_t>(1, mesh.ordinaryCount() / kSamples);
    std::array<double, 5> weights{};
    // 1
    for (std::size_t i = step / 2; i < mesh.ordinaryCount(); i += step) {
      const MirrorTriangle& t = mesh.triangles()[i];
      const dvec3 toEye = eye - t.position(1.0 / 3, 1.0 / 3);
      if (!(glm::dot(t.normal(1.0 / 3, 1.0 / 3), toEye) > 0)) continue;
      const double square = glm::dot(toEye, toEye);
      const double solid =
          0.5 * std::abs(glm::dot(glm::cross(t.edge1, t.edge2), toEye)) / (square * std::sqrt(square));
      weights[std::size_t(findFate(t, mesh.radius(), scene, eye))] += solid * double(step);
    }
    const double all = weights[0] + weights[1] + weights[2] + weights[3] + weights[4];
    PartForecast forecast;
    forecast.pixels = all * pixelsPerTangent * pixelsPerTangent;
    if (all > 0) {
      forecast.oneToOne = std::max({weights[0], weights[1], weights[2]}) / all;
      forecast.nearFocus = weights[std::size_t(Fate::NearFocus)] / all;
      forecast.self = weights[std::size_t(Fate::Self)] / all;
    }
    forecasts.push_back(forecast);
  }
  return forecasts;
}

PartCosts expectCosts(const PartForecast& forecast, Bend bend, std::size_t vertices,
                      std::size_t mirrorTriangles) {
  const double perVertex = bend == Bend::Convex ? kConvexVertexMs : kOtherVertexMs;
  return {kPartMs + kMirrorTriangleMs * double(mirrorTriangles) + perVertex * double(vertices),
          kBoundPixelMs * forecast.pixels};
}

}  // namespace catoptric::virtual_object
