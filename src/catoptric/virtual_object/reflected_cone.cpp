// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/reflected_cone.h"

#include <algorithm>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

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
    return !(glm::dot(offset, cone_.axis) <
             distance * (cosine_ * std::sqrt(1.0 - covered * covered) - sine_ * covered));
  }

 private:
  const ReflectedCone& cone_;
  bool meetsAll_, isWide_;
  double sine_, cosine_;
};

}  // namespace

bool ReflectedCone::mayMeet(const dvec3& ballCentre, double ballRadius) const {
  return ConeTest(*this).mayMeet(ballCentre, ballRadius);
}

ReflectedCone makeReflectedCone(const ReflectorMesh& mesh, const ReflectedRays& rays) {
  ReflectedCone cone;
  cone.centre = mesh.centre();
  cone.radius = mesh.bodyRadius();
  dvec3 sum(0);
  for (std::size_t t = 0; t < mesh.ordinaryCount(); ++t)
    if (rays.isMapped[t])
      for (std::size_t k = 0; k < 3; ++k) sum += rays.directions[mesh.corners()[3 * t + k]];
  if (!(glm::length(sum) > 0)) {
    cone.halfAngleRadians = glm::pi<double>();
    return cone;
  }
  cone.axis = glm::normalize(sum);
  // Within a triangle normals are interpolated: its rays stay between those of the corners, but for terms of
  // the second order.
  constexpr double kBetween = 0.25, kLeast = 1e-3;
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
  cone.halfAngleRadians = widest + kBetween * largest + kLeast;
  return cone;
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
  for (const VertexRuns::Ball& ball : runs.balls()) {
    const dvec3 centre(coneFromWorld * dvec4(ball.centre, 1.0));
    mayReflect.push_back(ball.radius >= 0 && test.mayMeet(centre, ball.radius));
  }
}

}  // namespace catoptric::virtual_object
