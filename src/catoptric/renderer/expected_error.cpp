// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/expected_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::renderer {
namespace {

using virtual_object::MirrorSample;
using virtual_object::MirrorTriangle;

constexpr double kShare = 0.95;      // of the percentile
constexpr double kStart = 1e-4;      // of the mirror's radius: a ray does not meet where it starts
constexpr double kReached = 1e-3;    // of the way: X is what the ray meets
constexpr double kFarAway = 1e5;     // of the scene's radius: as far as a point of the sky is taken to be
constexpr double kTolerance = 1e-7;  // sine of the angle between normal and half vector
constexpr int kNewtonSteps = 24;

struct Displacement {
  double px = kLostPx;
  bool isObject = false;
};

class Forecast {
 public:
  explicit Forecast(const MapErrorQuery& query)
      : q_(query),
        least_(kStart * query.mesh.radius()),
        far_(kFarAway * std::max(query.world.bounds.radius(), query.mesh.radius())),
        pixelsPerTangent_(0.5 * query.camera.heightPx / query.camera.tanHalfFovY),
        // A convex mirror does not show itself; where it does, in facets, the truth ignores it, too.
        ignoredPart_(query.world.reflectors[query.reflector].isConvex ? query.scene.ownPart : core::kNoId) {}

  [[nodiscard]] Displacement displace(const MirrorSample& sample) const {
    const MirrorTriangle& t = q_.mesh.triangles()[sample.at.triangle];
    const dvec3 j = t.position(sample.at.u, sample.at.v);
    const dvec3 normal = glm::normalize(t.normal(sample.at.u, sample.at.v));
    const dvec3 direction = core::reflectDirection(glm::normalize(j - q_.camera.eye), normal);
    // 1
    const auto real = findHit(j, direction);
    const environment_map::MapView::Shown shown = q_.map.look(j, direction);
    // 4
    Displacement result;
    result.isObject = isObject(real ? real->triangle : core::kNoId) || isObject(shown.triangle);
    if (isFollowed(shown.triangle)) return result;
    // 2
    const bool isSky = shown.triangle == core::kNoId;
    const dvec3 x = isSky ? j + far_ * shown.point : shown.point;
    const auto found = virtual_object::searchReflectionPoint(
        q_.mesh.triangles(), sample.at, q_.camera.eye, x, kNewtonSteps, kTolerance, 0.5 * q_.mesh.radius());
    if (!found.converged || !isOnMirror(found.at)) return result;
    const double pixelsPerUnit = findPixelsPerUnit(t, sample, j, x);
    if (!isSeenFrom(found.law.position, x, shown.triangle, 1.0 / pixelsPerUnit)) return result;
    // 3
    const double halfTexel = (isSky ? far_ : shown.distance) / q_.mapTexels;
    result.px = std::min(kLostPx,
                         glm::length(toPixels(found.law.position) - toPixels(j)) + halfTexel * pixelsPerUnit);
    return result;
  }

 private:
  [[nodiscard]] std::optional<geometry::TriangleHit> findHit(const dvec3& from, const dvec3& to) const {
    return geometry::findNearestHit(q_.scene.triangles, from, to, least_ / glm::length(to), core::kNoId,
                                    ignoredPart_);
  }
  [[nodiscard]] bool isObject(std::uint32_t triangle) const {
    return triangle != core::kNoId && !q_.world.parts[q_.scene.parts[triangle]].shell;
  }
  /// Is there another picture in the truth?
  [[nodiscard]] bool isFollowed(std::uint32_t triangle) const {
    if (triangle == core::kNoId) return false;
    const std::uint32_t reflector = q_.world.parts[q_.scene.parts[triangle]].reflector;
    return reflector != core::kNoId && (q_.bounces > 1 || q_.world.reflectors[reflector].isRefractor());
  }
  [[nodiscard]] bool isOnMirror(const virtual_object::SurfacePoint& at) const {
    constexpr double kSlack = 1e-6;
    return at.triangle < q_.mesh.ordinaryCount() && std::min({at.u, at.v, 1.0 - at.u - at.v}) > -kSlack;
  }
  /// Or a point of the same object that a pixel, `footprint` wide, does not tell from it?
  [[nodiscard]] bool isSeenFrom(const dvec3& from, const dvec3& x, std::uint32_t triangle,
                                double footprint) const {
    const auto hit = findHit(from, x - from);
    if (!hit || triangle == core::kNoId) return !hit;
    const double missing = std::abs(1.0 - hit->distance);
    if (missing < kReached) return true;
    const auto objectOf = [&](std::uint32_t t) { return q_.world.parts[q_.scene.parts[t]].object; };
    return objectOf(hit->triangle) == objectOf(triangle) && missing * glm::length(x - from) <= footprint;
  }
  [[nodiscard]] dvec2 toPixels(const dvec3& point) const {
    const dvec3 away = point - q_.camera.eye;
    return pixelsPerTangent_ / glm::dot(away, q_.camera.forward) *
           dvec2(glm::dot(away, q_.camera.right), glm::dot(away, q_.camera.up));
  }
  /// Of a length across the sample's ray, at the distance of x: the area of its pencil of rays says.
  [[nodiscard]] double findPixelsPerUnit(const MirrorTriangle& t, const MirrorSample& sample, const dvec3& j,
                                         const dvec3& x) const {
    const double area = std::abs(
        virtual_object::findPencil(t, q_.camera.eye, sample.at.u, sample.at.v).areaAt(glm::length(x - j)));
    return std::sqrt(sample.cellPixels / std::max(area, 1e-300));
  }

  const MapErrorQuery& q_;
  double least_, far_, pixelsPerTangent_;
  std::uint32_t ignoredPart_;
};

/// Of values with weights.
double findPercentile(std::vector<std::pair<double, double>> values) {
  double all = 0, sum = 0;
  std::sort(values.begin(), values.end());
  for (const auto& [value, weight] : values) all += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= kShare * all) return value;
  return 0;
}

}  // namespace

MapError expectMapError(const MapErrorQuery& query, std::span<const MirrorSample> samples,
                        double stopBeyondPx) {
  const Forecast forecast(query);
  double all = 0, beyond = 0;
  for (const MirrorSample& sample : samples) all += sample.pixels;
  std::vector<std::pair<double, double>> mirror, object;
  // Not in their order, which goes over the mirror from end to end: what is wrong is met soon.
  constexpr std::size_t kStrides = 7;
  for (std::size_t k = 0; k < kStrides; ++k)
    for (std::size_t i = k; i < samples.size(); i += kStrides) {
      const Displacement d = forecast.displace(samples[i]);
      mirror.emplace_back(d.px, samples[i].pixels);
      if (d.isObject) object.push_back(mirror.back());
      if (d.px > stopBeyondPx) beyond += samples[i].pixels;
      if (beyond > (1 - kShare) * all) return {stopBeyondPx, stopBeyondPx, true};
    }
  return {findPercentile(std::move(mirror)), findPercentile(std::move(object)), false};
}

}  // namespace catoptric::renderer
