// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/implicit_reflector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catoptric/core/polynomial.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kMostSteps = 40;
constexpr double kLongestStep = 0.25;  // of the mirror's radius
// Step 2: of eight neighbours so many may be better than a seed at which a search starts; more where it is
// grazed, for there reflections lie in narrow strips.
constexpr int kBetterNeighbours = 2, kBetterWhereGrazed = 3;
constexpr double kGrazing = 0.3, kBehind = 0.1;  // sines
constexpr double kSine = 1e-10;                  // between half vector and normal: a reflection
constexpr double kSame = 1e-6;                   // of the mirror's radius: reflections nearer are one
constexpr double kClose = 1e-8;  // of it: where the next step back onto the surface is rounding
constexpr std::size_t kMostSeeds = 4096;
constexpr std::size_t kEnough = 480;  // seeds, where the surface bends more than ...
constexpr double kFine = 0.25;        // ... of the mirror's radius between them, as 240 on a sphere do
constexpr int kLookingAround = 2;     // times in a row
constexpr double kReach = 1;          // of the seeds' spacing: where the valley is sampled
constexpr double kFarthest = 3;       // of that: others farther away have seeds of their own
constexpr double kPair = 8;           // of it: reflections this near may have a third between them

/// Do E and Q see it from the side, a little from behind at most?
bool isGrazed(const Reflection& seed, const dvec3& eye, const dvec3& point) {
  const auto sees = [&](const dvec3& from) {
    const dvec3 d = from - seed.position;
    const double sine = glm::dot(d, seed.normal) / glm::length(d);
    return sine > -kBehind && sine < kGrazing;
  };
  return sees(eye) && sees(point);
}

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
    const double determinant = h11 * h22 - h12 * h12;
    return t1 * ((h12 * g2 - h22 * g1) / determinant) + t2 * ((h12 * g1 - h11 * g2) / determinant);
  }
};

ImplicitReflector::ImplicitReflector(std::shared_ptr<const geometry::ImplicitSurface> surface, bool isTurned,
                                     std::span<const vec3> points, double radius, std::size_t fewestSeeds)
    : surface_(std::move(surface)), side_(isTurned ? -1 : 1), radius_(radius) {
  spreadSeeds(points, fewestSeeds);
  findNeighbours();
}

/// Between points of the surface, squared: how far apart they are, and how much the surface bends between
/// them, so that a thin tube has seeds around it.
double ImplicitReflector::measureSquared(const Reflection& a, const Reflection& b) const {
  const dvec3 apart = a.position - b.position, bend = radius_ * (a.normal - b.normal);
  return glm::dot(apart, apart) + glm::dot(bend, bend);
}

/// Step 1: the farthest points first.
void ImplicitReflector::spreadSeeds(std::span<const vec3> points, std::size_t fewest) {
  std::vector<Reflection> on(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec3 at = surface_->project(dvec3(points[i]));
    on[i] = {at, side_ * glm::normalize(surface_->gradient(at))};
  }
  std::vector<double> squared(points.size(), std::numeric_limits<double>::infinity());
  std::size_t farthest = 0;
  spacing_ = radius_;
  while (seeds_.size() < points.size() && spacing_ > kSame * radius_ && seeds_.size() < kMostSeeds &&
         (seeds_.size() < fewest || (seeds_.size() < kEnough && spacing_ > kFine * radius_))) {
    const Reflection seed = on[farthest];
    seeds_.push_back(seed);
    squared[farthest] = 0;
    farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      squared[i] = std::min(squared[i], measureSquared(on[i], seed));
      if (squared[i] > squared[farthest]) farthest = i;
    }
    spacing_ = std::sqrt(squared[farthest]);
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
bool ImplicitReflector::add(const State& s, ImplicitReflections& found) const {
  if (!s.isReflection() || !(std::abs(s.offset) <= 1e-9 * radius_)) return false;
  if (!surface_->isOnSheet(s.at)) return false;
  for (const Reflection& r : found)
    if (glm::distance(r.position, s.at) < kSame * radius_) return false;
  if (found.count == ImplicitReflections::kMost) return false;
  found.all[std::size_t(found.count++)] = {s.at, s.normal};
  return true;
}

void ImplicitReflector::search(const dvec3& near, const dvec3& eye, const dvec3& point,
                               ImplicitReflections& found, int lookingAround) const {
  const State s = descend(near, eye, point);
  const bool isNew = add(s, found);
  if (lookingAround > 0 && (isNew || (s.isBright() && !s.isReflection())))
    lookAlongValley(s, eye, point, found, lookingAround - 1);
}

/// Step 5.
void ImplicitReflector::lookAlongValley(const State& s, const dvec3& eye, const dvec3& point,
                                        ImplicitReflections& found, int lookingAround) const {
  const Tangent t = differentiate(s);
  // Eigenvalues: weak along the valley, strong across it.
  const double middle = 0.5 * (t.h11 + t.h22), half = 0.5 * (t.h11 - t.h22), root = std::hypot(half, t.h12);
  const double strong = middle + std::copysign(root, middle), weak = middle - std::copysign(root, middle);
  if (!(std::abs(strong) < 1e300) || !(std::abs(strong) > 0)) return;
  const double angle = 0.5 * std::atan2(t.h12, half);  // of the larger one's vector
  const dvec3 u = t.t1 * std::cos(angle) + t.t2 * std::sin(angle),
              v = t.t2 * std::cos(angle) - t.t1 * std::sin(angle);
  const dvec3 &valley = middle > 0 ? v : u, &wall = middle > 0 ? u : v;
  const double bend = radius_ * glm::dot(valley, surface_->hessian(s.at) * valley) / s.gradientLength;
  const double reach = kReach * spacing_ / std::sqrt(1 + bend * bend);
  const auto slopeAt = [&](double along) {
    const State side = evaluateOn(s.at + valley * along, eye, point);
    const dvec3 back = wall * (glm::dot(wall, side.across) / strong);
    return glm::dot(valley, evaluateOn(side.at - back, eye, point).across);
  };
  const double here = glm::dot(valley, s.across), left = slopeAt(-reach), right = slopeAt(reach);
  if (!(std::abs(left) + std::abs(right) < 1e300)) return;
  const double cubic[4] = {s.isReflection() ? 0 : here, weak * reach, 0.5 * (left + right) - here,
                           0.5 * (right - left) - weak * reach};
  const core::RealRoots others = core::findRealRoots(std::span(cubic).subspan(s.isReflection() ? 1 : 0));
  for (const double along : others)
    if (std::abs(along) < kFarthest)
      search(s.at + valley * (along * reach), eye, point, found, lookingAround);
}

/// Step 6. The derivative along the chord taken for a cubic with a zero at either end.
void ImplicitReflector::lookBetween(const Reflection& a, const Reflection& b, const dvec3& eye,
                                    const dvec3& point, ImplicitReflections& found) const {
  if (measureSquared(a, b) > kPair * kPair * spacing_ * spacing_) return;
  const dvec3 chord = b.position - a.position;
  const auto bendAt = [&](const Reflection& r) {
    const Tangent t = differentiate(evaluateOn(r.position, eye, point));
    const double x = glm::dot(t.t1, chord), y = glm::dot(t.t2, chord);
    return t.h11 * x * x + 2 * t.h12 * x * y + t.h22 * y * y;
  };
  const double bendA = bendAt(a), bendB = bendAt(b);
  if (bendA * bendB > 0)
    search(a.position + chord * (bendA / (bendA + bendB)), eye, point, found, kLookingAround);
}

/// Where `near` would be seen from `far` in the tangent plane at its foot on the surface: right where it all
/// but touches, which seeds are too far apart to resolve.
dvec3 ImplicitReflector::mirrorAtFoot(const dvec3& near, const dvec3& far) const {
  const dvec3 foot = surface_->project(near), normal = glm::normalize(surface_->gradient(foot));
  const double a = std::abs(glm::dot(near - foot, normal)), b = std::abs(glm::dot(far - foot, normal));
  const dvec3 flat = far - normal * glm::dot(far - foot, normal);
  return surface_->project(glm::mix(foot, flat, a / std::max(a + b, 1e-300)));
}

ImplicitReflections ImplicitReflector::findReflections(const dvec3& eye, const dvec3& point) const {
  ImplicitReflections found;
  // 2
  std::array<double, kMostSeeds> merits;
  for (std::size_t i = 0; i < seeds_.size(); ++i)
    merits[i] = evaluate(seeds_[i].position, seeds_[i].normal, eye, point).merit;
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    const auto& around = neighbours_[i];
    const auto better =
        std::count_if(around.begin(), around.end(), [&](std::uint16_t k) { return merits[k] < merits[i]; });
    if (better <= kBetterNeighbours || (better <= kBetterWhereGrazed && isGrazed(seeds_[i], eye, point)))
      search(seeds_[i].position, eye, point, found, kLookingAround);
  }
  for (const auto& [near, far] : {std::pair(eye, point), std::pair(point, eye)})
    search(mirrorAtFoot(near, far), eye, point, found, kLookingAround);
  // 6
  for (int i = 0; i < found.count; ++i)
    for (int k = 0; k < i; ++k)
      lookBetween(found.all[std::size_t(i)], found.all[std::size_t(k)], eye, point, found);
  return found;
}

std::optional<Reflection> ImplicitReflector::findFromBestSeed(const dvec3& eye, const dvec3& point) const {
  double least = std::numeric_limits<double>::infinity();
  const Reflection* best = nullptr;
  for (const Reflection& seed : seeds_) {
    const double merit = evaluate(seed.position, seed.normal, eye, point).merit;
    if (merit < least) least = merit, best = &seed;
  }
  ImplicitReflections found;
  if (best) search(best->position, eye, point, found, 0);
  return found.count ? std::optional(found.all[0]) : std::nullopt;
}

}  // namespace catoptric::virtual_object
