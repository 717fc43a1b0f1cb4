// SPDX-License-Identifier: Apache-2.0
// Which ray of a map passes through a scene point?
//
// In: a continued ray map, the scene point Q (world), a texel whose ray passes near it. Out: the first mirror
// point on that ray, the length of the path from there to Q, and whether the ray is one of the trace.
//   1. Origin o(p) and direction r(p) of the ray are bilinear in the texel coordinates p. The residual is
//      w = e - t r with e = Q - o and t = e.r / r.r: what is missing from the ray to Q, across the ray.
//   2. Gauss-Newton on w: columns a = o_x + t r_x and b = o_y + t r_y, made perpendicular to r; 2 x 2 normal
//      equations give the step. A step under half a texel is taken on the linear map and is the last one:
//      what it leaves is a hundredth of it. Two steps are usual.
//   3. A step that leaves the map is shortened to its edge; the second time the search ends there and the
//      last step is taken anyway, which continues the map linearly.
//   4. The mirror point lies in the direction that the chart gives for p, at the interpolated distance.
//
// Departures from 2004: the paper takes the nearest ray of the leaf; that is off by up to half the distance
// of two rays, several pixels. Failures: where several rays of one trace pass through Q (concave mirrors
// behind their focus) one of them is found. Cost: 25 ns a step. Source: Martin & Popescu 2004, section 6.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr int kMostSteps = 8;
constexpr float kTolerance = 0.5f;  // texels; the step after it is a hundred times smaller
constexpr int kMostShortened = 2;
constexpr int kShortenings = 5;

/// Four floats that the compiler keeps in one register; glm's vectors it does not.
using Four = float __attribute__((vector_size(16)));

/// A RayTexel, or its change per texel: origin and distance, direction and between.
struct RayFours {
  Four origin, direction;
};
static_assert(sizeof(RayTexel) == sizeof(RayFours));

struct Interpolated {
  RayFours ray, dx, dy;
};

float dot3(const Four& a, const Four& b) {
  const Four product = a * b;
  return product[0] + product[1] + product[2];
}

vec3 toVec3(const Four& v) {
  return {v[0], v[1], v[2]};
}

bool isFilled(const RayMap& map, const vec2& p) {
  return p.x >= 0 && p.y >= 0 && p.x < float(map.size - 1) && p.y < float(map.size - 1) &&
         map.isCell(int(p.x), int(p.y));
}

bool isRay(const RayMap& map, const vec2& p) {
  if (!(p.x >= 0 && p.y >= 0 && p.x < float(map.size) && p.y < float(map.size))) return false;
  const int x = int(std::lround(p.x)), y = int(std::lround(p.y));
  return x < map.size && y < map.size && map.states[map.at(x, y)] == TexelState::Ray;
}

/// Step 1; p must be filled.
Interpolated interpolate(const RayMap& map, const vec2& p) {
  const int x = int(p.x), y = int(p.y);
  const float u = p.x - float(x), v = p.y - float(y);
  const RayTexel* t = &map.texels[map.at(x, y)];
  RayFours a, b, c, d;
  std::memcpy(&a, t, sizeof a);
  std::memcpy(&b, t + 1, sizeof b);
  std::memcpy(&c, t + map.size, sizeof c);
  std::memcpy(&d, t + map.size + 1, sizeof d);
  Interpolated at;
  const auto blend = [u, v](const Four& v00, const Four& v10, const Four& v01, const Four& v11, Four& value,
                            Four& dx, Four& dy) {
    const Four top = v10 - v00, low = v11 - v01;
    const Four left = v00 + u * top;
    dx = top + v * (low - top);
    dy = v01 + u * low - left;
    value = left + v * dy;
  };
  blend(a.origin, b.origin, c.origin, d.origin, at.ray.origin, at.dx.origin, at.dy.origin);
  blend(a.direction, b.direction, c.direction, d.direction, at.ray.direction, at.dx.direction,
        at.dy.direction);
  return at;
}

/// Step 2; `along` is t in lengths of the direction.
vec2 computeStep(const Interpolated& at, const vec3& q, float& along) {
  const Four r = at.ray.direction, e = Four{q.x, q.y, q.z, 0} - at.ray.origin;
  const float perRr = 1 / dot3(r, r);
  along = dot3(e, r) * perRr;
  const Four w = e - along * r;
  const Four a = at.dx.origin + along * at.dx.direction, b = at.dy.origin + along * at.dy.direction;
  // The part of a and b along r is taken out of their products; w has none.
  const float ar = dot3(a, r), br = dot3(b, r);
  const float aa = dot3(a, a) - ar * ar * perRr, ab = dot3(a, b) - ar * br * perRr,
              bb = dot3(b, b) - br * br * perRr;
  const float aw = dot3(a, w), bw = dot3(b, w);
  const float determinant = aa * bb - ab * ab;
  // Near a focus the rays of a neighbourhood meet and no step says which; a little damping keeps it finite.
  const float safe = std::max(determinant, 1e-6f * (aa + bb) * (aa + bb) + 1e-30f);
  return vec2(bb * aw - ab * bw, aa * bw - ab * aw) / safe;
}

vec2 limit(const vec2& step, float most) {
  const float length = glm::length(step);
  return length > most ? step * (most / length) : step;
}

/// Step 4; `beyond` is added to p without looking at the map there.
FoundRay finish(const RayMap& map, const Interpolated& at, const vec2& p, const vec2& beyond, const vec3& q,
                bool isInside) {
  const Four origin = at.ray.origin + beyond.x * at.dx.origin + beyond.y * at.dy.origin;
  const float distance = origin[3];
  const float between = at.ray.direction[3] + beyond.x * at.dx.direction[3] + beyond.y * at.dy.direction[3];
  const vec3 direction = map.chart.directionAt(map.lower + (p + beyond) * map.step);
  FoundRay found;
  found.mirrorPoint = map.location + std::max(distance, 0.01f * at.ray.origin[3]) * direction;
  found.rest = std::max(between, 0.0f) + glm::length(q - toVec3(origin));
  found.isInside = isInside;
  return found;
}

void prefetch(const RayMap& map, const vec2& p) {
  const std::size_t at = map.at(int(p.x), int(p.y));
  for (const std::size_t row : {at, at + std::size_t(map.size)}) {
    __builtin_prefetch(&map.texels[row]);
    __builtin_prefetch(&map.texels[row + 1]);
    __builtin_prefetch(&map.states[row]);
  }
}

}  // namespace

void RaySearch::start(const RayMap& map, const vec3& scenePoint, std::uint32_t seed) {
  point_ = scenePoint;
  p_ = vec2(seed % std::uint32_t(map.size), seed / std::uint32_t(map.size));
  steps_ = shortened_ = 0;
  prefetch(map, p_);
}

bool RaySearch::advance(const RayMap& map) {
  assert(isFilled(map, p_));
  const Interpolated at = interpolate(map, p_);
  float along = 0;
  const vec2 step = limit(computeStep(at, point_, along), 0.25f * float(map.size));
  const bool hasConverged = glm::dot(step, step) < kTolerance * kTolerance;
  vec2 next = p_ + step;
  if (!hasConverged && steps_ < kMostSteps && shortened_ < kMostShortened) {
    // 3
    float part = 1;
    for (int k = 0; k < kShortenings && !isFilled(map, next); ++k) next = p_ + (part *= 0.5f) * step;
    if (part == 1 || isFilled(map, next)) {
      p_ = next;
      ++steps_;
      if (part < 1) ++shortened_;
      prefetch(map, p_);
      return false;
    }
  }
  const bool isInside = hasConverged && along > 0 && isRay(map, p_ + step);
  found_ = finish(map, at, p_, step, point_, isInside);
  return true;
}

FoundRay findRay(const RayMap& map, const vec3& scenePoint, std::uint32_t seed) {
  RaySearch search;
  search.start(map, scenePoint, seed);
  while (!search.advance(map)) {
  }
  return search.found();
}

}  // namespace catoptric::reflection_morphing
