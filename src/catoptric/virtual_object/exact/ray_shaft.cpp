// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/exact/ray_shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::virtual_object {
namespace {

constexpr double kLeastCosine = 0.35;     // of a ray to the mean direction
constexpr double kRoundingMargin = 2e-6;  // the fragment tests in float: bounds are widened by so much

struct Interval2 {
  dvec2 lower{1e300}, upper{-1e300};
  void add(const dvec2& x) {
    lower = glm::min(lower, x);
    upper = glm::max(upper, x);
  }
};

}  // namespace

std::optional<RayShaft> RayShaft::find(const RaySpan& rays, double reach) {
  if (rays.origins.empty()) return std::nullopt;
  dvec3 sum(0);
  for (const vec4& d : rays.directions) sum += dvec3(vec3(d));
  const double length = glm::length(sum);
  if (!(length > 1e-3 * double(rays.directions.size()))) return std::nullopt;
  RayShaft shaft;
  const dvec3 w = sum / length;
  const dvec3 aside = std::abs(w.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 u = glm::normalize(glm::cross(aside, w)), v = glm::cross(w, u);
  shaft.frame_ = {u, v, w};
  const dvec3 middle(vec3(rays.origins[rays.origins.size() / 2]));

  // 1. The heights at which the rays begin, then where they pass the lowest of them and the far end.
  double lowest = 1e300, highest = -1e300, size = 0, leastCosine = 1;
  for (std::size_t i = 0; i < rays.origins.size(); ++i) {
    const dvec3 origin(vec3(rays.origins[i]));
    const double height = glm::dot(origin - middle, w);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    size = std::max({size, std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    leastCosine = std::min(leastCosine, glm::dot(dvec3(vec3(rays.directions[i])), w));
  }
  if (!(leastCosine > kLeastCosine)) return std::nullopt;
  Interval2 start, end, slope;
  shaft.length_ = reach + (highest - lowest);
  for (std::size_t i = 0; i < rays.origins.size(); ++i) {
    const dvec3 offset = dvec3(vec3(rays.origins[i])) - middle, d(vec3(rays.directions[i]));
    const dvec2 s = dvec2(glm::dot(d, u), glm::dot(d, v)) / glm::dot(d, w);
    const dvec2 x = dvec2(glm::dot(offset, u), glm::dot(offset, v)) - s * (glm::dot(offset, w) - lowest);
    start.add(x);
    end.add(x + s * shaft.length_);
    slope.add(s);
  }
  const double margin = kRoundingMargin * (size + reach * 0.1);
  shaft.centre_ = middle + (lowest - margin) * w;
  shaft.latestStart_ = highest - lowest + 2.0 * margin;
  shaft.start_ = {0.5 * (start.lower + start.upper), 0.5 * (start.upper - start.lower) + margin};
  shaft.slope_ = {0.5 * (slope.lower + slope.upper), 0.5 * (slope.upper - slope.lower) + kRoundingMargin};
  shaft.end_ = {0.5 * (end.lower + end.upper),
                0.5 * (end.upper - end.lower) + margin + kRoundingMargin * shaft.length_};
  // Heights count from a little below the lowest origin now; the lines through start_ and end_ move by less
  // than the margin of the slope.
  shaft.start_.half += margin * (glm::abs(shaft.slope_.centre) + shaft.slope_.half);
  shaft.end_.half += margin * (glm::abs(shaft.slope_.centre) + shaft.slope_.half);
  shaft.makePlanes();
  return shaft;
}

void RayShaft::makePlanes() {
  const auto [u, v, w] = frame_;
  const dvec2 upper = start_.centre + start_.half, lower = start_.centre - start_.half;
  const dvec2 upperSlope = (end_.centre + end_.half - upper) / length_,
              lowerSlope = (end_.centre - end_.half - lower) / length_;
  planes_ = {u - upperSlope.x * w, v - upperSlope.y * w, lowerSlope.x * w - u, lowerSlope.y * w - v, -w};
  limits_ = {upper.x, upper.y, -lower.x, -lower.y, 0.0};
}

RayShaft::Extent RayShaft::extentAt(double height) const {
  if (height < 0.0) return {start_.centre + slope_.centre * height, start_.half - slope_.half * height};
  const double share = height / length_;
  return {start_.centre + (end_.centre - start_.centre) * share,
          start_.half + (end_.half - start_.half) * share};
}

dvec3 RayShaft::toFrame(const vec3& point) const {
  const dvec3 offset = dvec3(point) - centre_;
  return {glm::dot(offset, frame_.u), glm::dot(offset, frame_.v), glm::dot(offset, frame_.w)};
}

bool RayShaft::mayMeet(const vec3& lower, const vec3& upper) const {
  // 2
  const dvec3 middle = 0.5 * (dvec3(lower) + dvec3(upper)) - centre_,
              half = 0.5 * (dvec3(upper) - dvec3(lower));
  for (std::size_t i = 0; i < planes_.size(); ++i)
    if (glm::dot(planes_[i], middle) - glm::dot(glm::abs(planes_[i]), half) > limits_[i]) return false;
  return true;
}

double RayShaft::findNearest(const vec3& lower, const vec3& upper) const {
  if (!mayMeet(lower, upper)) return std::numeric_limits<double>::infinity();
  const dvec3 middle = 0.5 * (dvec3(lower) + dvec3(upper)) - centre_,
              half = 0.5 * (dvec3(upper) - dvec3(lower));
  return glm::dot(frame_.w, middle) - glm::dot(glm::abs(frame_.w), half);
}

std::optional<ShaftHit> RayShaft::mayMeet(const vec3& worldA, const vec3& worldB, const vec3& worldC,
                                          bool singleSided) const {
  // 3. Corners beyond one of the planes.
  const dvec3 corners[3] = {toFrame(worldA), toFrame(worldB), toFrame(worldC)};
  const double lowest = std::min({corners[0].z, corners[1].z, corners[2].z});
  const double highest = std::max({corners[0].z, corners[1].z, corners[2].z});
  if (highest < 0.0) return std::nullopt;
  Extent extents[3];
  int beyond[4] = {0, 0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const double share = corners[k].z / length_;
    const dvec2 centre = start_.centre + (end_.centre - start_.centre) * share;
    const dvec2 half = start_.half + (end_.half - start_.half) * share;
    const dvec2 offset = dvec2(corners[k]) - centre;
    for (int axis = 0; axis < 2; ++axis) {
      beyond[2 * axis] += offset[axis] > half[axis] ? 1 : 0;
      beyond[2 * axis + 1] += offset[axis] < -half[axis] ? 1 : 0;
    }
    extents[k] = corners[k].z < 0.0 ? extentAt(corners[k].z) : Extent{centre, half};
  }
  for (const int count : beyond)
    if (count == 3) return std::nullopt;

  // Edges on the wrong side of all rays.
  bool frontPossible = true, backPossible = !singleSided, frontCertain = true, backCertain = !singleSided;
  for (int k = 0; k < 3; ++k) {
    const dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
    const dvec2 at = dvec2(a) - extents[k].centre, atHalf = extents[k].half;
    const double rise = b.z - a.z;
    const dvec2 edge = dvec2(b) - dvec2(a) - slope_.centre * rise, edgeHalf = slope_.half * std::abs(rise);
    const double side = at.x * edge.y - at.y * edge.x;
    const double slack = std::abs(at.x) * edgeHalf.y + (std::abs(edge.y) + edgeHalf.y) * atHalf.x +
                         std::abs(at.y) * edgeHalf.x + (std::abs(edge.x) + edgeHalf.x) * atHalf.y;
    // A front face turns clockwise, seen along the ray.
    frontPossible = frontPossible && side - slack <= 0.0;
    backPossible = backPossible && side + slack >= 0.0;
    frontCertain = frontCertain && side + slack < 0.0;
    backCertain = backCertain && side - slack > 0.0;
  }
  if (!frontPossible && !backPossible) return std::nullopt;

  // 4. Heights at which rays cross the plane n . x = k, and whether all of them do.
  const dvec3 n = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double k = glm::dot(n, corners[0]);
  const double along = n.z + glm::dot(dvec2(n), slope_.centre);
  const double alongHalf = glm::dot(glm::abs(dvec2(n)), slope_.half);
  ShaftHit hit{std::max(lowest, 0.0), highest, false};
  if (std::abs(along) <= alongHalf) return hit;
  const double rest = k - glm::dot(dvec2(n), start_.centre);
  const double restHalf = glm::dot(glm::abs(dvec2(n)), start_.half);
  const double quotients[4] = {
      (rest - restHalf) / (along - alongHalf), (rest - restHalf) / (along + alongHalf),
      (rest + restHalf) / (along - alongHalf), (rest + restHalf) / (along + alongHalf)};
  const auto [least, most] = std::minmax_element(quotients, quotients + 4);
  hit.nearest = std::max(hit.nearest, *least);
  hit.furthest = std::min(hit.furthest, *most);
  if (hit.furthest < 0.0) return std::nullopt;
  hit.coversAll = (frontCertain || backCertain) && hit.nearest > latestStart_;
  return hit;
}

}  // namespace catoptric::virtual_object
