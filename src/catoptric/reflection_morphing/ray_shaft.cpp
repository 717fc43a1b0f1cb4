// SPDX-License-Identifier: Apache-2.0
// Which points can no ray of a trace reach?
//
// In: a continued ray map (world, metres). Out: eight planes that have all its rays on one side.
//   1. The axis is the mean direction of the rays, e one of eight directions across it.
//   2. The side's slope is the largest of (r.e) / (r.axis) over the rays' directions r. Its normal is
//      n = e - slope axis, so that n.r <= 0 for every ray: along none of them does n.q grow.
//   3. So n.q <= offset, the largest n.o over the rays' origins o, on every ray, and on every mixture of rays
//      with positive weights: on all that findRays() interpolates.
//   4. What is seen ends a texel and a half before the continued map does, so that the last step of a search,
//      a twelfth of a texel out of its cell, stays inside. Slopes and offsets are widened by some thousandths
//      for its curvature and for rounding.
//
// Departures from 2004: the paper has no such test. Where a ray leaves at more than 84 degrees from the axis,
// as from a sphere, there is no shaft.
#include "catoptric/reflection_morphing/ray_shaft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::reflection_morphing {
namespace {

constexpr float kLeastCosine = 0.1f;
constexpr float kMargin = 0.003f;  // of the slopes' and the offsets' range

struct Frame {
  vec3 across[2], axis;
};

/// Calls visit(origin, direction) with every ray that findRays() may mix in.
template <class Visit>
void forEachRay(const RayMap& map, const Visit& visit) {
  for (std::size_t i = 0; i < map.texels.size(); ++i)
    if (map.states[i] != TexelState::Empty) visit(map.texels[i].origin, map.texels[i].direction);
}

/// Step 1; nothing if the rays have no axis in common.
std::optional<Frame> findFrame(const RayMap& map) {
  dvec3 sum(0);
  forEachRay(map, [&](const vec3&, const vec3& direction) { sum += dvec3(direction); });
  const double length = glm::length(sum);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  const Chart chart = makeChart(sum / length);
  const Frame frame{{chart.right, chart.up}, chart.axis};
  bool isNarrow = true;
  forEachRay(map, [&](const vec3&, const vec3& direction) {
    const float along = glm::dot(direction, frame.axis);
    isNarrow = isNarrow && along > kLeastCosine * std::sqrt(glm::dot(direction, direction));
  });
  return isNarrow ? std::optional(frame) : std::nullopt;
}

}  // namespace

RayShaft makeRayShaft(const RayMap& map) {
  constexpr int kSides = RayShaft::kSides;
  RayShaft shaft;
  const std::optional<Frame> frame = findFrame(map);
  if (!frame) return shaft;
  // 2
  float cosine[kSides], sine[kSides], slope[kSides], least[kSides], most[kSides];
  for (int i = 0; i < kSides; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * float(i) / float(kSides);
    cosine[i] = std::cos(angle), sine[i] = std::sin(angle);
    slope[i] = most[i] = -1e30f, least[i] = 1e30f;
  }
  forEachRay(map, [&](const vec3&, const vec3& r) {
    const float perAlong = 1 / glm::dot(r, frame->axis);
    const float x = glm::dot(r, frame->across[0]) * perAlong, y = glm::dot(r, frame->across[1]) * perAlong;
    for (int i = 0; i < kSides; ++i) slope[i] = std::max(slope[i], x * cosine[i] + y * sine[i]);
  });
  // 4: opposite sides together say how wide the shaft is.
  float wide[kSides];
  for (int i = 0; i < kSides; ++i) wide[i] = slope[i] + kMargin * (slope[i] + slope[(i + 4) % kSides]);
  // 3
  forEachRay(map, [&](const vec3& o, const vec3&) {
    const float x = glm::dot(o, frame->across[0]), y = glm::dot(o, frame->across[1]),
                z = glm::dot(o, frame->axis);
    for (int i = 0; i < kSides; ++i) {
      const float height = x * cosine[i] + y * sine[i] - wide[i] * z;
      least[i] = std::min(least[i], height), most[i] = std::max(most[i], height);
    }
  });
  for (std::size_t i = 0; i < kSides; ++i) {
    const vec3 normal = cosine[i] * frame->across[0] + sine[i] * frame->across[1] - wide[i] * frame->axis;
    shaft.normalX[i] = normal.x, shaft.normalY[i] = normal.y, shaft.normalZ[i] = normal.z;
    shaft.offset[i] = most[i] + kMargin * (most[i] - least[i]);
  }
  return shaft;
}

}  // namespace catoptric::reflection_morphing
