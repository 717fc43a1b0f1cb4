// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/mirror_rects.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::renderer {
namespace {

constexpr int kMargin = 2;                  // pixels
constexpr std::size_t kFewVertices = 4096;  // cost less than the pixels beside the mirror that they save
constexpr std::size_t kMostRects = 16;      // reading one costs as much as some thousand pixels

struct Interval {
  double lower, upper;
};

/// Of k where the plane row - k w = 0 touches the sphere; `sphere`: centre and radius. Nothing if the sphere
/// reaches the eye's plane.
std::optional<Interval> findTouching(const dvec4& row, const dvec4& w, const dvec3& centre, double radius) {
  // |row(c) - k w(c)| = r |row.xyz - k w.xyz|, a quadratic equation
  const double a = glm::dot(row, dvec4(centre, 1.0)), b = glm::dot(w, dvec4(centre, 1.0));
  const dvec3 rowDirection(row), wDirection(w);
  const double rr = radius * radius;
  const double second = b * b - rr * glm::dot(wDirection, wDirection);
  if (!(b > 0.0 && second > 0.0)) return std::nullopt;
  const double first = a * b - rr * glm::dot(rowDirection, wDirection),
               zeroth = a * a - rr * glm::dot(rowDirection, rowDirection);
  const double root = std::sqrt(std::max(first * first - second * zeroth, 0.0));
  return Interval{(first - root) / second, (first + root) / second};
}

/// From -1 to 1 to pixels [first, second).
std::pair<int, int> toPixels(const Interval& k, int sizePx) {
  const double half = 0.5 * sizePx;
  const double lower = std::clamp((k.lower + 1.0) * half, -kMargin - 1.0, sizePx + kMargin + 1.0),
               upper = std::clamp((k.upper + 1.0) * half, -kMargin - 1.0, sizePx + kMargin + 1.0);
  return {std::max(int(std::floor(lower)) - kMargin, 0), std::min(int(std::ceil(upper)) + kMargin, sizePx)};
}

std::optional<gl::Scissor> toRect(const Interval& across, const Interval& up, int widthPx, int heightPx) {
  const auto [x0, x1] = toPixels(across, widthPx);
  const auto [y0, y1] = toPixels(up, heightPx);
  if (x1 <= x0 || y1 <= y0) return std::nullopt;
  return gl::Scissor{x0, y0, x1 - x0, y1 - y0};
}

/// Of the sphere around a mirror; of its vertices where they are few, for a mirror seen aslant fills little
/// of its sphere.
std::optional<gl::Scissor> findMirrorRect(const scene::WorldGeometry& world,
                                          const scene::Reflector& reflector, const dmat4& clipFromWorld,
                                          int widthPx, int heightPx) {
  const auto rect =
      findSphereRect(clipFromWorld, reflector.centre, 1.001 * reflector.radius, widthPx, heightPx);
  const scene::Part& part = world.parts[reflector.part];
  if (!rect || part.vertexCount > kFewVertices) return rect;
  const auto tighter =
      findPointsRect(clipFromWorld, std::span(world.positions).subspan(part.firstVertex, part.vertexCount),
                     widthPx, heightPx);
  return tighter ? tighter : rect;
}

}  // namespace

std::optional<gl::Scissor> findSphereRect(const dmat4& clipFromWorld, const dvec3& centre, double radius,
                                          int widthPx, int heightPx) {
  const dmat4 rows = glm::transpose(clipFromWorld);
  const auto across = findTouching(rows[0], rows[3], centre, radius),
             up = findTouching(rows[1], rows[3], centre, radius);
  if (!across || !up) {
    if (glm::dot(rows[3], dvec4(centre, 1.0)) < -radius * glm::length(dvec3(rows[3]))) return std::nullopt;
    return gl::Scissor{0, 0, widthPx, heightPx};
  }
  return toRect(*across, *up, widthPx, heightPx);
}

std::optional<gl::Scissor> findPointsRect(const dmat4& clipFromWorld, std::span<const vec3> points,
                                          int widthPx, int heightPx) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Interval across{kInfinite, -kInfinite}, up = across;
  for (const vec3& point : points) {
    const dvec4 at = clipFromWorld * dvec4(dvec3(point), 1.0);
    if (!(at.w > 0.0)) return std::nullopt;
    const double x = at.x / at.w, y = at.y / at.w;
    across = {std::min(across.lower, x), std::max(across.upper, x)};
    up = {std::min(up.lower, y), std::max(up.upper, y)};
  }
  return points.empty() ? std::nullopt : toRect(across, up, widthPx, heightPx);
}

std::vector<gl::Scissor> findMirrorRects(const scene::WorldGeometry& world, const dmat4& clipFromWorld,
                                         int widthPx, int heightPx) {
  std::vector<gl::Scissor> rects;
  std::int64_t pixels = 0;
  for (const scene::Reflector& reflector : world.reflectors) {
    const auto rect = findMirrorRect(world, reflector, clipFromWorld, widthPx, heightPx);
    if (!rect) continue;
    rects.push_back(*rect);
    pixels += std::int64_t(rect->width) * rect->height;
  }
  if (rects.size() > kMostRects || pixels >= std::int64_t(widthPx) * heightPx)
    return {{0, 0, widthPx, heightPx}};
  return rects;
}

}  // namespace catoptric::renderer
