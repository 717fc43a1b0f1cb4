// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/extruded_reflector.h"

#include <algorithm>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kSkirtPoints = 3;
constexpr double kMostTurn = 0.35;  // radians from one skirt point to the next

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

dvec2 turn(const dvec2& v, double radians) {
  const double s = std::sin(radians), c = std::cos(radians);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// The reflected ray at a point; straight on where the mirror turns away. Not unit unless `view` is.
dvec2 reflectAt(const dvec2& view, const dvec2& normal) {
  const double facing = glm::dot(view, normal);
  return facing <= 0 ? view - normal * (2.0 * facing / glm::dot(normal, normal)) : view;
}

}  // namespace

ExtrudedReflector::ExtrudedReflector(const geometry::ExtrusionFit& profile, double skirt)
    : profile_(profile) {
  if (!profile_.isClosed && skirt > 0) addSkirt(skirt);
}

void ExtrudedReflector::addSkirt(double width) {
  skirtPoints_ = kSkirtPoints;
  const double step = width / double(kSkirtPoints);
  for (const bool atEnd : {false, true}) {
    std::vector<dvec2>&points = profile_.points, &normals = profile_.normals;
    for (std::size_t i = 0; i < kSkirtPoints; ++i) {
      const std::size_t last = atEnd ? points.size() - 1 : 0, before = atEnd ? last - 1 : 1;
      const dvec2 n = normals[last], m = normals[before];
      const double length = glm::distance(points[last], points[before]);
      const double bend = std::atan2(cross(m, n), glm::dot(m, n)) * step / length;
      const double angle = std::clamp(bend, -kMostTurn, kMostTurn);
      const dvec2 tangent =
          atEnd ? dvec2(n.y, -n.x) : dvec2(-n.y, n.x);  // bright side to the left of the order
      const dvec2 point = points[last] + step * turn(tangent, 0.5 * angle);
      points.insert(atEnd ? points.end() : points.begin(), point);
      normals.insert(atEnd ? normals.end() : normals.begin(), turn(n, angle));
    }
  }
}

/// Step 1.
void ExtrudedReflector::setEye(const dvec3& eye) {
  eye_ = eye;
  eyeFlat_ = profile_.project(eye);
  points_.clear(), normals_.clear(), rays_.clear(), isSkirt_.clear();
  const std::size_t n = profile_.points.size(), most = profile_.isClosed ? n : n - 1;  // most: segments
  const auto isFront = [&](std::size_t i) {
    return glm::dot(profile_.normals[i % n], eyeFlat_ - profile_.points[i % n]) >= 0;
  };
  std::size_t first = 0;  // the first front-facing point, after a back-facing one where there is any
  if (profile_.isClosed)
    while (first < n && isFront(first + n - 1)) ++first;
  while (first < 2 * n && !isFront(first)) ++first;
  if (first >= 2 * n) return;
  std::size_t last = first;
  if (first > 0) --first;
  while (last < first + most && last + 1 < (profile_.isClosed ? 3 * n : n)) {
    ++last;
    if (!isFront(last)) break;
  }
  for (std::size_t i = first; i <= last; ++i) {
    points_.push_back(profile_.points[i % n]);
    normals_.push_back(profile_.normals[i % n]);
    rays_.push_back(reflectAt(glm::normalize(points_.back() - eyeFlat_), normals_.back()));
    if (i < last) isSkirt_.push_back(i < skirtPoints_ || i + 1 + skirtPoints_ >= n);
  }
  if (profile_.isClosed) std::fill(isSkirt_.begin(), isSkirt_.end(), std::uint8_t(0));
}

/// In along ray `first`, over the chord, out along ray `last`: the cell lies to the left of that path. Where
/// the path turns right the cell reaches around the corner.
bool ExtrudedReflector::isInCell(std::uint32_t first, std::uint32_t last, const dvec2& point) const {
  const dvec2 a = points_[first], b = points_[last], chord = b - a;
  const bool besideFirst = cross(rays_[first], point - a) <= 0,
             besideLast = cross(rays_[last], point - b) >= 0, before = cross(chord, point - a) >= 0;
  const bool turnsFirst = cross(chord, rays_[first]) < 0, turnsLast = cross(chord, rays_[last]) < 0;
  if (turnsFirst && turnsLast) return besideFirst || before || besideLast;
  if (turnsFirst) return besideLast && (before || besideFirst);
  if (turnsLast) return besideFirst && (before || besideLast);
  return besideFirst && before && besideLast;
}

std::optional<std::uint32_t> ExtrudedReflector::locate(const dvec2& point) const {
  if (points_.size() < 2) return std::nullopt;
  std::uint32_t first = 0, last = std::uint32_t(points_.size() - 1);
  if (!isInCell(first, last, point)) return std::nullopt;
  while (last - first > 1) {
    const std::uint32_t middle = (first + last) / 2;
    (isInCell(first, middle, point) ? last : first) = middle;
  }
  return isInCell(first, last, point) ? std::optional(first) : std::nullopt;
}

std::optional<std::uint32_t> ExtrudedReflector::locateByAll(const dvec2& point) const {
  for (std::uint32_t i = 0; i + 1 < points_.size(); ++i)
    if (isInCell(i, i + 1, point)) return i;
  return std::nullopt;
}

/// Step 3: 0..1 along the segment. The side of the ray on which the point lies changes from its first to its
/// last point: halving, quickened by the secant.
double ExtrudedReflector::solveWithin(std::uint32_t segment, const dvec2& point) const {
  const dvec2 p = points_[segment], dp = points_[segment + 1] - p, n = normals_[segment],
              dn = normals_[segment + 1] - n;
  const auto side = [&](double u) {
    const dvec2 at = p + u * dp;
    return cross(reflectAt(at - eyeFlat_, n + u * dn), point - at);
  };
  double low = 0, high = 1, atLow = side(0), atHigh = side(1);
  if (!(atLow < 0)) return 0;
  if (!(atHigh > 0)) return 1;
  int kept = 0;  // which end the last two secants left where it was
  for (int step = 0; step < 100; ++step) {
    double u = (low * atHigh - high * atLow) / (atHigh - atLow);
    if (!(u > low && u < high)) u = 0.5 * (low + high);
    if (!(u > low && u < high)) return u;
    const double value = side(u);
    if (value == 0) return u;
    if (value < 0) {
      low = u, atLow = value;
      if (kept > 0) atHigh *= 0.5;
      kept = 1;
    } else {
      high = u, atHigh = value;
      if (kept < 0) atLow *= 0.5;
      kept = -1;
    }
    if (high - low < 1e-16) break;
  }
  return 0.5 * (low + high);
}

std::optional<FoundPoint> ExtrudedReflector::find(const dvec3& point) const {
  const dvec2 flat = profile_.project(point);
  const auto segment = locate(flat);
  if (!segment) return std::nullopt;
  const double u = solveWithin(*segment, flat);
  const dvec2 at = glm::mix(points_[*segment], points_[*segment + 1], u),
              n = glm::normalize(glm::mix(normals_[*segment], normals_[*segment + 1], u));
  if (!(glm::dot(n, eyeFlat_ - at) > 0 && glm::dot(n, flat - at) > 0)) return std::nullopt;
  // 4
  const double toEye = glm::distance(at, eyeFlat_), toPoint = glm::distance(at, flat);
  const double share = toEye / (toEye + toPoint);
  const double along = glm::dot(profile_.axis, glm::mix(eye_, point, share) - profile_.origin);
  FoundPoint found;
  found.position = profile_.origin + at.x * profile_.x + at.y * profile_.y + along * profile_.axis;
  found.normal = n.x * profile_.x + n.y * profile_.y;
  found.isPastBoundary = isSkirt_[*segment] || along < profile_.low || along > profile_.high;
  return found;
}

}  // namespace catoptric::virtual_object
