// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/reflected_cone.h"

#include <algorithm>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kTriangleRun = 32;

/// ReflectedCone::mayMeet() without an angle for each ball.
class ConeTest {
 public:
  explicit ConeTest(const ReflectedCone& cone)
      : cone_(cone),
        meetsAll_(cone.halfAngleRadians >= glm::pi<double>()),
        isWide_(cone.halfAngleRadians > 0.5 * glm::pi<double>()),
        sine_(std::sin(cone.halfAngleRadians)),
        cosine_(std::cos(cone.halfAngleRadians)) {}

  [[nodiscard]] bool mayMeet(const dvec3& ballCentre, double ballRadius) const {
    if (meetsAll_) return true;
    const dvec3 offset = ballCentre - cone_.centre;
    const double distance = glm::length(offset), both = cone_.radius + ballRadius;
    if (!(distance > both)) return true;
    const double covered = both / distance;  // the sine of what both balls cover
    if (isWide_ && covered >= sine_) return true;
    // The angle from the axis against the half angle and what is covered, by their cosines.
    if (glm::dot(offset, cone_.axis) <
        distance * (cosine_ * std::sqrt(1.0 - covered * covered) - sine_ * covered))
      return false;
    return !cone_.sides || std::none_of(cone_.sides->begin(), cone_.sides->end(), [&](const dvec3& normal) {
      return glm::dot(offset, normal) < -both;
    });
  }

 private:
  const ReflectedCone& cone_;
  bool meetsAll_, isWide_;
  double sine_, cosine_;
};

/// Calls visit(direction) for the rays at the corners of the triangles that are seen.
template <class Visit>
void forEachRay(const ReflectorMesh& mesh, const ReflectedRays& rays, const Visit& visit) {
  for (std::size_t t = 0; t < mesh.ordinaryCount(); ++t)
    if (rays.isMapped[t])
      for (std::size_t k = 0; k < 3; ++k) visit(rays.directions[mesh.corners()[3 * t + k]]);
}

/// Across the axis, along the longer and the shorter extent of the rays.
std::array<dvec3, 2> findExtents(const ReflectorMesh& mesh, const ReflectedRays& rays, const dvec3& axis) {
  const MapFrame frame = makeMapFrame(axis);
  double xx = 0, xy = 0, yy = 0;
  forEachRay(mesh, rays, [&](const dvec3& direction) {
    const double u = glm::dot(direction, frame.x), v = glm::dot(direction, frame.y);
    xx += u * u, xy += u * v, yy += v * v;
  });
  const double turn = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const dvec3 longer = std::cos(turn) * frame.x + std::sin(turn) * frame.y;
  return {longer, glm::cross(axis, longer)};
}

/// All rays on their inner sides, `margin` radians away. For a cone narrower than a half space.
std::array<dvec3, 4> findSides(const ReflectorMesh& mesh, const ReflectedRays& rays, const dvec3& axis,
                               double margin) {
  std::array<dvec3, 4> sides;
  const std::array<dvec3, 2> extents = findExtents(mesh, rays, axis);
  for (std::size_t i = 0; i < 2; ++i) {
    double leastTangent = 0, mostTangent = 0;  // of angles from the axis
    forEachRay(mesh, rays, [&](const dvec3& direction) {
      const double tangent = glm::dot(direction, extents[i]) / glm::dot(direction, axis);
      leastTangent = std::min(leastTangent, tangent), mostTangent = std::max(mostTangent, tangent);
    });
    const double least = std::atan(leastTangent) - margin, most = std::atan(mostTangent) + margin;
    sides[2 * i] = std::cos(least) * extents[i] - std::sin(least) * axis;
    sides[2 * i + 1] = std::sin(most) * axis - std::cos(most) * extents[i];
  }
  return sides;
}

}  // namespace

bool ReflectedCone::mayMeet(const dvec3& ballCentre, double ballRadius) const {
  return ConeTest(*this).mayMeet(ballCentre, ballRadius);
}

ReflectedCone makeReflectedCone(const ReflectorMesh& mesh, const ReflectedRays& rays) {
  ReflectedCone cone;
  cone.centre = mesh.centre();
  cone.radius = mesh.bodyRadius();
  dvec3 sum(0);
  forEachRay(mesh, rays, [&](const dvec3& direction) { sum += direction; });
  if (!(glm::length(sum) > 0)) {
    cone.halfAngleRadians = glm::pi<double>();
    return cone;
  }
  cone.axis = glm::normalize(sum);
  // Within a triangle normals are interpolated: its rays stay between those of the corners, but for terms of
  // the second order.
  constexpr double kBetween = 0.25, kLeast = 1e-3, kNarrow = 1.2;
  double leastCosine = 1, longestChord = 0;  // squared; between unit vectors
  for (std::size_t t = 0; t < mesh.ordinaryCount(); ++t) {
    if (!rays.isMapped[t]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const dvec3& direction = rays.directions[mesh.corners()[3 * t + k]];
      const dvec3& next = rays.directions[mesh.corners()[3 * t + (k + 1) % 3]];
      const dvec3 chord = next - direction;
      leastCosine = std::min(leastCosine, glm::dot(direction, cone.axis));
      longestChord = std::max(longestChord, glm::dot(chord, chord));
    }
  }
  const double widest = std::acos(std::max(leastCosine, -1.0));
  const double largest = 2.0 * std::asin(std::min(0.5 * std::sqrt(longestChord), 1.0));
  const double margin = kBetween * largest + kLeast;
  cone.halfAngleRadians = widest + margin;
  if (cone.halfAngleRadians < kNarrow)
    cone.sides = findSides(mesh, rays, cone.axis, margin / std::cos(widest));
  return cone;
}

ReflectedCone makePictureCone(const dmat4& clipFromWorld, const dvec3& eye, const ivec2& sizePx,
                              const gl::Scissor& rectangle) {
  constexpr double kMarginPx = 1;
  const dmat4 rows = glm::transpose(clipFromWorld);
  const dvec2 size(sizePx), first = dvec2(rectangle.x, rectangle.y) - kMarginPx,
                            last = first + dvec2(rectangle.width, rectangle.height) + 2.0 * kMarginPx;
  const dvec2 lower = 2.0 * first / size - 1.0, upper = 2.0 * last / size - 1.0;
  std::array<dvec3, 4> sides;
  for (int k = 0; k < 2; ++k) {
    sides[std::size_t(k)] = glm::normalize(dvec3(rows[k] - lower[k] * rows[3]));
    sides[std::size_t(k) + 2] = glm::normalize(dvec3(upper[k] * rows[3] - rows[k]));
  }
  std::array<dvec3, 4> corners;
  ReflectedCone cone;
  cone.axis = dvec3(0);
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 along = glm::normalize(glm::cross(sides[i], sides[(i + 1) % 4]));
    corners[i] = glm::dot(along, dvec3(rows[3])) < 0 ? -along : along;
    cone.axis += corners[i];
  }
  cone.centre = eye;
  cone.axis = glm::normalize(cone.axis);
  double leastCosine = 1;
  for (const dvec3& corner : corners) leastCosine = std::min(leastCosine, glm::dot(corner, cone.axis));
  cone.halfAngleRadians = std::acos(leastCosine) + 1e-6;
  cone.sides = sides;
  return cone;
}

TriangleRuns::TriangleRuns(std::span<const vec3> positions, std::span<const std::uint32_t> indices)
    : triangles_(indices.size() / 3) {
  for (std::size_t first = 0; first < triangles_; first += kTriangleRun) {
    core::Box box;
    for (std::size_t i = 3 * first; i < 3 * std::min(first + kTriangleRun, triangles_); ++i)
      box.add(dvec3(positions[indices[i]]));
    balls_.push_back({box.centre(), box.radius()});
  }
}

std::size_t TriangleRuns::mark(const ReflectedCone& cone, const dmat4& coneFromWorld,
                               std::vector<std::uint8_t>& mayMeet) const {
  mayMeet.resize(triangles_);
  const ConeTest test(cone);
  const bool isMoved = coneFromWorld != dmat4(1.0);
  std::size_t leftOut = 0;
  for (std::size_t run = 0; run < balls_.size(); ++run) {
    const dvec3& ball = balls_[run].centre;
    const dvec3 centre = isMoved ? dvec3(coneFromWorld * dvec4(ball, 1.0)) : ball;
    const std::size_t first = run * kTriangleRun, count = std::min(kTriangleRun, triangles_ - first);
    const bool isMet = test.mayMeet(centre, balls_[run].radius);
    std::fill_n(&mayMeet[first], count, std::uint8_t(isMet));
    leftOut += isMet ? 0 : count;
  }
  return leftOut;
}

VertexRuns::VertexRuns(const raster::TessellatedObjects& objects, std::size_t runLength)
    : vertices_(objects.positions.size()), runLength_(runLength) {
  std::vector<core::Box> boxes((vertices_ + runLength - 1) / runLength);
  for (std::size_t i = 0; i + 2 < objects.indices.size(); i += 3) {
    core::Box triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.add(dvec3(objects.positions[objects.indices[i + k]]));
    for (std::size_t k = 0; k < 3; ++k) boxes[objects.indices[i + k] / runLength].add(triangle);
  }
  for (const core::Box& box : boxes)
    balls_.push_back(box.isEmpty() ? Ball{} : Ball{box.centre(), box.radius()});
}

std::size_t VertexRuns::countLeftOut(std::span<const std::uint8_t> mayReflect) const {
  std::size_t count = 0;
  for (std::size_t run = 0; run < mayReflect.size(); ++run)
    if (mayReflect[run] == 0) count += std::min(runLength_, vertices_ - run * runLength_);
  return count;
}

void findReflectedRuns(const VertexRuns& runs, const ReflectedCone& cone, const dmat4& coneFromWorld,
                       std::vector<std::uint8_t>& mayReflect) {
  mayReflect.clear();
  const ConeTest test(cone);
  const bool isMoved = coneFromWorld != dmat4(1.0);
  for (const Ball& ball : runs.balls()) {
    const dvec3 centre = isMoved ? dvec3(coneFromWorld * dvec4(ball.centre, 1.0)) : ball.centre;
    mayReflect.push_back(ball.radius >= 0 && test.mayMeet(centre, ball.radius));
  }
}

}  // namespace catoptric::virtual_object
