// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/implicit_reflector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catoptric/virtual_object/root_isolation.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kMostSteps = 40;
constexpr double kLongestStep = 0.25;  // of the mirror's radius
constexpr double kSine = 1e-10;        // between half vector and normal: a reflection
constexpr double kSingular = 1e-10;    // determinant over squares
constexpr double kSame = 1e-6;         // of the mirror's radius: reflections nearer are one
constexpr double kClose = 1e-8;        // of it: where the next step back onto the surface is rounding
constexpr std::size_t kEnough = 480;   // seeds, where the surface bends more than ...
constexpr double kFine = 0.25;         // ... of the mirror's radius between them, as 240 on a sphere do

}  // namespace

/// Everything at one point of the surface.
struct ImplicitReflector::State {
  dvec3 at, normal;          ///< normal unit
  dvec3 fromEye, fromPoint;  ///< unit, from E and from Q to J
  double eyeDistance, pointDistance;
  double gradientLength = 1, offset = 0;  ///< of f; f over it
  dvec3 pathGradient, across;             ///< of the path; its part across the normal
  double merit;                           ///< length, squared

  [[nodiscard]] bool isBright() const {
    return glm::dot(normal, fromEye) < 0 && glm::dot(normal, fromPoint) < 0;
  }
  [[nodiscard]] bool isStationary() const {
    return glm::dot(across, across) <= kSine * kSine * glm::dot(pathGradient, pathGradient);
  }
  [[nodiscard]] bool isReflection() const { return isBright() && isStationary(); }
};

/// The path's second derivatives in an orthonormal basis of the tangent plane.
struct ImplicitReflector::Tangent {
  dvec3 t1, t2;
  double h11, h12, h22;

  [[nodiscard]] dvec3 findStep(const dvec3& gradient) const {
    const double g1 = glm::dot(t1, gradient), g2 = glm::dot(t2, gradient);
    const double determinant = h11 * h22 - h12 * h12, square = h11 * h11 + 2 * h12 * h12 + h22 * h22;
    if (!(std::abs(determinant) > kSingular * square))  // reflections on a curve: the shortest step
      return (t1 * (h11 * g1 + h12 * g2) + t2 * (h12 * g1 + h22 * g2)) / -square;
    return t1 * ((h12 * g2 - h22 * g1) / determinant) + t2 * ((h12 * g1 - h11 * g2) / determinant);
  }
};

ImplicitReflector::ImplicitReflector(std::shared_ptr<const geometry::ImplicitSurface> surface, bool isTurned,
                                     const geometry::MeshView& mesh, double radius)
    : surface_(std::move(surface)),
      side_(isTurned ? -1 : 1),
      radius_(radius),
      patches_(surface_, side_, radius_, mesh.positions, mesh.indices) {
  spreadSeeds(mesh.positions);
  findNeighbours();
}

/// Between points of the surface, squared: how far apart they are, and how much the surface bends between
/// them, so that a thin tube has seeds around it.
double ImplicitReflector::measureSquared(const Reflection& a, const Reflection& b) const {
  const dvec3 apart = a.position - b.position, bend = radius_ * (a.normal - b.normal);
  return glm::dot(apart, apart) + glm::dot(bend, bend);
}

/// Step 1: the farthest points first.
void ImplicitReflector::spreadSeeds(std::span<const vec3> points) {
  std::vector<Reflection> on(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec3 at = surface_->project(dvec3(points[i]));
    on[i] = {at, side_ * glm::normalize(surface_->gradient(at))};
  }
  std::vector<double> squared(points.size(), std::numeric_limits<double>::infinity());
  std::size_t farthest = 0;
  double spacing = radius_;
  while (seeds_.size() < points.size() && spacing > kSame * radius_ &&
         (seeds_.size() < kSeeds || (seeds_.size() < kEnough && spacing > kFine * radius_))) {
    const Reflection seed = on[farthest];
    seeds_.push_back(seed);
    squared[farthest] = 0;
    farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      squared[i] = std::min(squared[i], measureSquared(on[i], seed));
      if (squared[i] > squared[farthest]) farthest = i;
    }
    spacing = std::sqrt(squared[farthest]);
  }
}

void ImplicitReflector::findNeighbours() {
  std::vector<std::pair<double, std::uint16_t>> order(seeds_.size());
  neighbours_.resize(seeds_.size());
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    for (std::size_t k = 0; k < seeds_.size(); ++k)
      order[k] = {k == i ? -1 : measureSquared(seeds_[i], seeds_[k]), std::uint16_t(k)};
    std::sort(order.begin(), order.end());  // the first is the seed itself
    for (std::size_t k = 0; k < kNeighbours; ++k)
      neighbours_[i][k] = order[std::min(k + 1, order.size() - 1)].second;
  }
}

ImplicitReflector::State ImplicitReflector::evaluate(const dvec3& at, const dvec3& normal, const dvec3& eye,
                                                     const dvec3& point) const {
  State s;
  s.at = at;
  s.normal = normal;
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

ImplicitReflector::State ImplicitReflector::evaluateOn(const dvec3& near, const dvec3& eye,
                                                       const dvec3& point) const {
  const dvec3 at = surface_->project(near, kClose * radius_);
  const auto [value, gradient] = surface_->sampleAt(at);
  const double length = std::max(glm::length(gradient), 1e-300);
  State s = evaluate(at, gradient * (side_ / length), eye, point);
  s.gradientLength = length;
  s.offset = value / length;
  return s;
}

ImplicitReflector::Tangent ImplicitReflector::differentiate(const State& s) const {
  const dvec3 helper = std::abs(s.normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 t1 = glm::normalize(glm::cross(helper, s.normal)), t2 = glm::cross(s.normal, t1);
  const double multiplier = side_ * glm::dot(s.pathGradient, s.normal) / s.gradientLength;
  const dmat3 hessian = surface_->hessian(s.at);
  const auto curvature = [&](const dvec3& a, const dvec3& b) {
    const double along = glm::dot(a, b);
    return (along - glm::dot(s.fromEye, a) * glm::dot(s.fromEye, b)) / s.eyeDistance +
           (along - glm::dot(s.fromPoint, a) * glm::dot(s.fromPoint, b)) / s.pointDistance -
           multiplier * glm::dot(a, hessian * b);
  };
  return {t1, t2, curvature(t1, t1), curvature(t1, t2), curvature(t2, t2)};
}

/// Step 3.
ImplicitReflector::State ImplicitReflector::descend(const dvec3& near, const dvec3& eye,
                                                    const dvec3& point) const {
  State s = evaluateOn(near, eye, point);
  for (int i = 0; i < kMostSteps && !s.isStationary(); ++i) {
    dvec3 step = differentiate(s).findStep(s.across);
    const double length = glm::length(step);
    if (!(length < 1e300)) break;
    step *= std::min(1.0, kLongestStep * radius_ / std::max(length, 1e-300));
    State next = evaluateOn(s.at + step, eye, point);
    for (int k = 0; k < 4 && !(next.merit < s.merit); ++k)
      next = evaluateOn(s.at + (step *= 0.4), eye, point);
    if (!(next.merit < s.merit)) break;
    s = next;
  }
  return s;
}

/// Step 4.
void ImplicitReflector::add(const State& s, ImplicitReflections& found) const {
  if (!s.isReflection() || !(std::abs(s.offset) <= 1e-9 * radius_)) return;
  if (!surface_->isOnSheet(s.at) || found.count == ImplicitReflections::kMost) return;
  for (const Reflection& r : found)
    if (glm::distance(r.position, s.at) < kSame * radius_) return;
  found.all[std::size_t(found.count++)] = {s.at, s.normal};
}

/// Step 5.
void ImplicitReflector::searchPastBoundary(const dvec3& eye, const dvec3& point,
                                           ImplicitReflections& found) const {
  std::array<double, kEnough> merits;
  for (std::size_t i = 0; i < seeds_.size(); ++i)
    merits[i] = evaluate(seeds_[i].position, seeds_[i].normal, eye, point).merit;
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    const auto& around = neighbours_[i];
    if (std::none_of(around.begin(), around.end(), [&](std::uint16_t k) { return merits[k] < merits[i]; }))
      add(descend(seeds_[i].position, eye, point), found);
  }
}

ImplicitReflections ImplicitReflector::findReflections(const dvec3& eye, const dvec3& point) const {
  ImplicitReflections found;
  for (const dvec3& at : isolateReflections(patches_, eye, point)) add(descend(at, eye, point), found);
  if (found.count == 0) searchPastBoundary(eye, point, found);
  return found;
}

}  // namespace catoptric::virtual_object
