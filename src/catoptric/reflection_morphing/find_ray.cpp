// SPDX-License-Identifier: Apache-2.0
// Which ray of a map passes through a scene point?
//
// In: a continued ray map, scene points (world), for each a texel whose ray passes near it. Out: the first
// mirror point on the ray through it, the length of the path from there to the point, and whether the ray is
// one of the trace.
//   1. Gauss-Newton on the interpolated map, eight searches side by side (ray_lanes.cpp); a lane whose search
//      has ended gets the next one.
//   2. A step under a quarter of a texel is taken on the linear map and is the last one: what it leaves is a
//      hundredth of it. One or two steps are usual.
//   3. A step that leaves the map is shortened to its edge; the second time the search ends there and the
//      last step is taken anyway, which continues the map linearly.
//
// Departures from 2004: the paper takes the nearest ray of the leaf; that is off by up to half the distance
// of two rays, several pixels. Failures: where several rays of one trace pass through Q (concave mirrors
// behind their focus) one of them is found. Cost: 20 ns a step. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/find_ray.h"

#include <cassert>

#include "catoptric/reflection_morphing/ray_lanes.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr int kMostSteps = 8;
constexpr float kTolerance = 0.25f;  // texels; the step after it is a hundred times smaller
constexpr int kMostShortened = 2;
constexpr int kShortenings = 5;

bool isRay(const RayMap& map, const vec2& p) {
  const vec2 q = p + 0.5f;
  if (!(q.x >= 0 && q.y >= 0 && q.x < float(map.size) && q.y < float(map.size))) return false;
  return map.states[map.at(int(q.x), int(q.y))] == TexelState::Ray;
}

void prefetch(const RayMap& map, const vec2& p) {
  const std::size_t at = map.at(int(p.x), int(p.y));
  for (const std::size_t row : {at, at + std::size_t(map.size)}) {
    __builtin_prefetch(&map.texels[row]);
    __builtin_prefetch(&map.texels[row + 1]);
    __builtin_prefetch(&map.states[row]);
  }
}

/// The searches that are under way.
class RaySearches {
 public:
  RaySearches(const RayMap& map, std::span<const RayQuery> queries, std::span<FoundRay> found)
      : map_(map), queries_(queries), found_(found) {}

  void run() {
    for (int lane = 0; lane < kRayLanes; ++lane)
      if (!startNext(lane)) start(lane, queries_.front());  // idles on something
    while (busy_ != 0) {
      evaluateRayLanes(map_, lanes_);
      for (int lane = 0; lane < kRayLanes; ++lane)
        if ((busy_ >> lane & 1u) != 0 && advance(lane)) startNext(lane);
    }
  }

 private:
  bool startNext(int lane) {
    if (next_ == queries_.size()) {
      busy_ &= ~(1u << lane);
      return false;
    }
    start(lane, queries_[next_]);
    answers_[lane] = queries_[next_].answer;
    busy_ |= 1u << lane;
    ++next_;
    return true;
  }
  void start(int lane, const RayQuery& query) {
    for (int k = 0; k < 3; ++k) lanes_.point[k][lane] = query.point[k];
    steps_[lane] = shortened_[lane] = 0;
    moveTo(lane, query.texel);
  }
  void moveTo(int lane, const vec2& p) {
    assert(map_.isFilled(p));
    const int x = int(p.x), y = int(p.y);
    lanes_.cell[lane] = &map_.texels[map_.at(x, y)];
    lanes_.x[lane] = p.x;
    lanes_.y[lane] = p.y;
    lanes_.u[lane] = p.x - float(x);
    lanes_.v[lane] = p.y - float(y);
  }

  /// Steps 2 and 3 for a lane that has been evaluated; true when its search has ended.
  bool advance(int lane) {
    const vec2 p(lanes_.x[lane], lanes_.y[lane]), step(lanes_.stepX[lane], lanes_.stepY[lane]);
    const bool hasConverged = glm::dot(step, step) < kTolerance * kTolerance;
    if (!hasConverged && steps_[lane] < kMostSteps && shortened_[lane] < kMostShortened) {
      float part = 1;
      vec2 next = p + step;
      for (int k = 0; k < kShortenings && !map_.isFilled(next); ++k) next = p + (part *= 0.5f) * step;
      if (map_.isFilled(next)) {
        moveTo(lane, next);
        ++steps_[lane];
        if (part < 1) ++shortened_[lane];
        return false;
      }
    }
    FoundRay& found = found_[answers_[lane]];
    found.mirrorPoint = {lanes_.mirror[0][lane], lanes_.mirror[1][lane], lanes_.mirror[2][lane]};
    found.rest = lanes_.rest[lane];
    found.isInside = hasConverged && lanes_.along[lane] > 0 && isRay(map_, p + step);
    found.texel = found.isInside && map_.isFilled(p + step) ? p + step : p;
    return true;
  }

  const RayMap& map_;
  std::span<const RayQuery> queries_;
  std::span<FoundRay> found_;
  RayLanes lanes_;
  std::uint32_t answers_[kRayLanes] = {};
  int steps_[kRayLanes] = {}, shortened_[kRayLanes] = {};
  std::size_t next_ = 0;
  unsigned busy_ = 0;
};

}  // namespace

void findRays(const RayMap& map, std::span<const RayQuery> queries, std::span<FoundRay> found) {
  if (queries.empty()) return;
  for (const RayQuery& query : queries) prefetch(map, query.texel);
  RaySearches(map, queries, found).run();
}

FoundRay findRay(const RayMap& map, const vec3& scenePoint, std::uint32_t seed) {
  const auto size = std::uint32_t(map.size);
  const RayQuery query{scenePoint, vec2(seed % size, seed / size), 0};
  FoundRay found;
  findRays(map, std::span(&query, 1), std::span(&found, 1));
  return found;
}

}  // namespace catoptric::reflection_morphing
