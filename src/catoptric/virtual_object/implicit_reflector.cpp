// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/implicit_reflector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::virtual_object {
namespace {

constexpr int kMostSteps = 40;
constexpr double kLongestStep = 0.25;  // of the mirror's radius
constexpr int kBetterNeighbours = 1;   // of a seed at which a search starts
constexpr double kSine = 1e-10;        // between half vector and normal: a reflection
constexpr double kSame = 1e-6;         // of the mirror's radius: reflections nearer are one
constexpr std::size_t kMostSeeds = 4096;

}  // namespace

/// Everything at one point of the surface.
struct ImplicitReflector::State {
  dvec3 at, normal;          ///< normal unit
  dvec3 fromEye, fromPoint;  ///< unit, from E and from Q to J
  double eyeDistance, pointDistance;
  double gradientLength;       ///< of f
  dvec3 pathGradient, across;  ///< of the path; its part across the normal
  double merit;                ///< length, squared

  [[nodiscard]] bool isReflection() const {
    return glm::dot(normal, fromEye) < 0 && glm::dot(normal, fromPoint) < 0 &&
           glm::dot(across, across) <= kSine * kSine * glm::dot(pathGradient, pathGradient);
  }
};

/// Step 1: the farthest points first.
ImplicitReflector::ImplicitReflector(const geometry::Quadric& surface, std::span<const vec3> points,
                                     double radius, std::size_t seeds)
    : surface_(surface), hessian_(surface.hessian()), radius_(radius) {
  std::vector<double> squared(points.size(), std::numeric_limits<double>::infinity());
  std::size_t farthest = 0;
  while (!points.empty() && seeds_.size() < std::min(seeds, kMostSeeds)) {
    const dvec3 seed(points[farthest]);
    seeds_.push_back(surface_.project(seed));
    squared[farthest] = 0;
    farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const dvec3 d = dvec3(points[i]) - seed;
      squared[i] = std::min(squared[i], glm::dot(d, d));
      if (squared[i] > squared[farthest]) farthest = i;
    }
    if (!(squared[farthest] > kSame * kSame * radius * radius)) break;
  }
  std::vector<std::pair<double, std::uint16_t>> order(seeds_.size());
  neighbours_.resize(seeds_.size());
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    for (std::size_t k = 0; k < seeds_.size(); ++k)
      order[k] = {glm::distance(seeds_[i], seeds_[k]), std::uint16_t(k)};
    std::sort(order.begin(), order.end());  // the first is the seed itself
    for (std::size_t k = 0; k < kNeighbours; ++k)
      neighbours_[i][k] = order[std::min(k + 1, order.size() - 1)].second;
  }
}

ImplicitReflector::State ImplicitReflector::evaluate(const dvec3& at, const dvec3& eye,
                                                     const dvec3& point) const {
  State s;
  s.at = at;
  const dvec3 gradient = surface_.gradient(at);
  s.gradientLength = std::max(glm::length(gradient), 1e-300);
  s.normal = gradient / s.gradientLength;
  const dvec3 e = at - eye, q = at - point;
  s.eyeDistance = std::max(glm::length(e), 1e-300);
  s.pointDistance = std::max(glm::length(q), 1e-300);
  s.fromEye = e / s.eyeDistance;
  s.fromPoint = q / s.pointDistance;
  s.pathGradient = s.fromEye + s.fromPoint;
  s.across = s.pathGradient - s.normal * glm::dot(s.normal, s.pathGradient);
  const double scale = s.eyeDistance * s.pointDistance / (s.eyeDistance + s.pointDistance);
  s.merit = scale * scale * glm::dot(s.across, s.across);
  return s;
}

/// Step 3: Newton's step in the tangent plane.
dvec3 ImplicitReflector::findStep(const State& s) const {
  const dvec3 helper = std::abs(s.normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 t1 = glm::normalize(glm::cross(helper, s.normal)), t2 = glm::cross(s.normal, t1);
  const double multiplier = glm::dot(s.pathGradient, s.normal) / s.gradientLength;
  const auto curvature = [&](const dvec3& a, const dvec3& b) {
    const double along = glm::dot(a, b);
    return (along - glm::dot(s.fromEye, a) * glm::dot(s.fromEye, b)) / s.eyeDistance +
           (along - glm::dot(s.fromPoint, a) * glm::dot(s.fromPoint, b)) / s.pointDistance -
           multiplier * glm::dot(a, hessian_ * b);
  };
  const double h11 = curvature(t1, t1), h12 = curvature(t1, t2), h22 = curvature(t2, t2);
  const double g1 = glm::dot(t1, s.across), g2 = glm::dot(t2, s.across);
  const double determinant = h11 * h22 - h12 * h12;
  return t1 * ((h12 * g2 - h22 * g1) / determinant) + t2 * ((h12 * g1 - h11 * g2) / determinant);
}

void ImplicitReflector::search(dvec3 at, const dvec3& eye, const dvec3& point,
                               ImplicitReflections& found) const {
  State s = evaluate(at, eye, point);
  for (int i = 0; i < kMostSteps && !s.isReflection(); ++i) {
    dvec3 step = findStep(s);
    const double length = glm::length(step);
    if (!(length < 1e300)) return;
    step *= std::min(1.0, kLongestStep * radius_ / std::max(length, 1e-300));
    State next = evaluate(surface_.project(s.at + step), eye, point);
    for (int k = 0; k < 4 && !(next.merit < s.merit); ++k)
      next = evaluate(surface_.project(s.at + (step *= 0.4)), eye, point);
    if (!(next.merit < s.merit)) break;
    s = next;
  }
  // 4
  if (!s.isReflection() || !(std::abs(surface_.value(s.at)) <= 1e-9 * radius_ * s.gradientLength)) return;
  for (const Reflection& r : found)
    if (glm::distance(r.position, s.at) < kSame * radius_) return;
  if (found.count < ImplicitReflections::kMost) found.all[std::size_t(found.count++)] = {s.at, s.normal};
}

/// Where `near` would be seen from `far` in the tangent plane at its foot on the surface: right where it all
/// but touches, which seeds are too far apart to resolve.
dvec3 ImplicitReflector::mirrorAtFoot(const dvec3& near, const dvec3& far) const {
  const dvec3 foot = surface_.project(near), normal = glm::normalize(surface_.gradient(foot));
  const double a = std::abs(glm::dot(near - foot, normal)), b = std::abs(glm::dot(far - foot, normal));
  const dvec3 flat = far - normal * glm::dot(far - foot, normal);
  return surface_.project(glm::mix(foot, flat, a / std::max(a + b, 1e-300)));
}

ImplicitReflections ImplicitReflector::findReflections(const dvec3& eye, const dvec3& point) const {
  ImplicitReflections found;
  // 2
  std::array<double, kMostSeeds> merits;
  for (std::size_t i = 0; i < seeds_.size(); ++i) merits[i] = evaluate(seeds_[i], eye, point).merit;
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    const auto& around = neighbours_[i];
    const auto better =
        std::count_if(around.begin(), around.end(), [&](std::uint16_t k) { return merits[k] < merits[i]; });
    if (better <= kBetterNeighbours) search(seeds_[i], eye, point, found);
  }
  for (const auto& [near, far] : {std::pair(eye, point), std::pair(point, eye)})
    search(mirrorAtFoot(near, far), eye, point, found);
  return found;
}

}  // namespace catoptric::virtual_object
