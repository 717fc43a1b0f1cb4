// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/view_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/virtual_object/mixed/interval_search.h"

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kSamples = 200;  // of a part, at most
constexpr double kNearFocus = 0.25;    // of the focal distance
constexpr double kBack = 1e-3;         // of the mirror's radius: a search that ends this near is back
constexpr double kStart = 1e-4;        // of the mirror's radius: a ray does not meet where it starts
constexpr double kInPartsMs = 6.0, kPartMs = 3.0, kConvexVertexMs = 2.5e-4, kSeedMs = 4e-4, kSearchMs = 4e-4,
                 kBoundPixelMs = 1.1e-4;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

enum class Fate : std::uint8_t { Before, Between, Beyond, NearFocus, Self };

/// Steps 2 to 4 for one triangle. `met`: what the ray meets.
Fate findFate(const MirrorTriangle& t, double radius, const SceneRays& scene, const dvec3& eye,
              std::optional<dvec3>& met) {
  const std::array<double, 2> focal = findFocalDistances(t, eye);
  const dvec3 origin = t.position(1.0 / 3, 1.0 / 3), direction = reflectAt(t, 1.0 / 3, 1.0 / 3, eye);
  const auto hit = geometry::findNearestHit(scene.triangles, origin, direction, kStart * radius);
  if (hit && scene.parts[hit->triangle] == scene.ownPart) return Fate::Self;
  const double distance = hit ? hit->distance : kInfinite;
  if (hit) met = origin + distance * direction;
  for (const double f : focal)
    if (std::isfinite(f) && std::abs(distance - f) < kNearFocus * f) return Fate::NearFocus;
  return Fate((focal[0] < distance ? 1 : 0) + (focal[1] < distance ? 1 : 0));
}

}  // namespace

std::vector<PartForecast> forecastView(std::span<const MirrorPart* const> parts, const SceneRays& scene,
                                       const dvec3& eye, double pixelsPerTangent) {
  std::vector<PartForecast> forecasts;
  for (const MirrorPart* part : parts) {
    const ReflectorMesh& mesh = *part->mesh;
    const std::size_t step = std::max<std::size_t>(1, mesh.ordinaryCount() / kSamples);
    std::array<double, 5> weights{};
    double notFound = 0;
    std::optional<IntervalSearch> search;
    if (part->bend != Bend::Convex) search.emplace(mesh, eye);
    // 1
    for (std::size_t i = step / 2; i < mesh.ordinaryCount(); i += step) {
      const MirrorTriangle& t = mesh.triangles()[i];
      const dvec3 toEye = eye - t.position(1.0 / 3, 1.0 / 3);
      if (!(glm::dot(t.normal(1.0 / 3, 1.0 / 3), toEye) > 0)) continue;
      const double square = glm::dot(toEye, toEye);
      const double solid =
          0.5 * std::abs(glm::dot(glm::cross(t.edge1, t.edge2), toEye)) / (square * std::sqrt(square));
      std::optional<dvec3> met;
      const auto fate = std::size_t(findFate(t, mesh.radius(), scene, eye, met));
      weights[fate] += solid * double(step);
      // 5
      if (!search || !met || fate >= kIntervals) continue;
      const auto back = search->find(*met, fate);
      if (!back || glm::distance(*back, t.position(1.0 / 3, 1.0 / 3)) > kBack * mesh.radius())
        notFound += solid * double(step);
    }
    const double all = weights[0] + weights[1] + weights[2] + weights[3] + weights[4];
    PartForecast forecast;
    forecast.pixels = all * pixelsPerTangent * pixelsPerTangent;
    if (all > 0) {
      for (std::size_t k = 0; k < kIntervals; ++k) forecast.shares[k] = weights[k] / all;
      forecast.nearFocus = weights[std::size_t(Fate::NearFocus)] / all;
      forecast.self = weights[std::size_t(Fate::Self)] / all;
      forecast.notFound = notFound / all;
    }
    forecasts.push_back(forecast);
  }
  return forecasts;
}

PartCosts expectCosts(const PartForecast& forecast, Bend bend, std::size_t vertices) {
  double intervals = 0;
  for (std::size_t k = 0; k < kIntervals; ++k) intervals += forecast.shows(k) ? 1 : 0;
  const double perVertex = bend == Bend::Convex ? kConvexVertexMs : kSeedMs + intervals * kSearchMs;
  return {kPartMs + perVertex * double(vertices), kBoundPixelMs * forecast.oneToOne() * forecast.pixels};
}

std::vector<std::uint8_t> chooseParts(std::span<const MirrorPart* const> parts,
                                      std::span<const PartForecast> forecasts, std::size_t vertices,
                                      bool all) {
  std::vector<std::uint8_t> isChosen(parts.size());
  double gain = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const PartCosts costs = expectCosts(forecasts[k], parts[k]->bend, vertices);
    isChosen[k] = forecasts[k].suitsVirtualObjects() && (all || costs.virtualMs < costs.boundMs) ? 1 : 0;
    if (isChosen[k] != 0) gain += costs.boundMs - costs.virtualMs;
  }
  if (!all && gain < kInPartsMs) isChosen.assign(parts.size(), 0);
  return isChosen;
}

}  // namespace catoptric::virtual_object
