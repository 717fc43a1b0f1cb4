// SPDX-License-Identifier: Apache-2.0
// Which ray of a map passes through a scene point?
//
// In: a ray table, scene points (world), for each a texel whose ray passes near it. Out: the first mirror
// point on the ray through it, the length of the path from there to the point, and whether the ray is one of
// the trace.
//   1. Gauss-Newton on the interpolated table, eight searches side by side (ray_lanes.cpp). All searches make
//      their first step, then those that are not at their end the second one, and so on.
//   2. A step under a tenth of a texel is taken on the linear map and is the last one: what it leaves is a
//      hundredth of it, more at the rim. One or two steps are usual.
//   3. A step that leaves the map is shortened to its edge; the second time the search ends there and the
//      last step is taken anyway, which continues the map linearly.
//
// Departures from 2004: the paper takes the nearest ray of the leaf; that is off by up to half the distance
// of two rays, several pixels. Failures: where several rays of one trace pass through Q (concave mirrors
// behind their focus) one of them is found. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/find_ray.h"

#include <algorithm>
#include <cassert>

#include "catoptric/reflection_morphing/ray_lanes.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr int kMostSteps = 8;
constexpr int kMostShortened = 2;
constexpr int kShortenings = 5;

/// The searches that are under way.
class RaySearches {
 public:
  RaySearches(const RayTable& table, RayBatch& batch) : table_(table), batch_(batch) {}

  void run(std::span<const std::uint8_t> which) {
    std::copy(which.begin(), which.end(), busy_.begin());
    busyCount_ = which.size();
    for (const std::uint8_t i : which) {
      shortened_[i] = 0;
      prefetch(i);
    }
    for (int step = 0; busyCount_ > 0; ++step) {
      std::size_t next = 0;
      const std::size_t count = busyCount_;
      for (std::size_t first = 0; first < count; first += kRayLanes) {
        const std::size_t lanes = std::min(count - first, std::size_t(kRayLanes));
        load(first, lanes);
        evaluateRayLanes(table_, lanes_);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::uint8_t i = busy_[first + lane];
          if (advance(int(lane), i, step == kMostSteps)) busy_[next++] = i;
        }
      }
      busyCount_ = next;
    }
  }

 private:
  void prefetch(std::uint8_t i) const {
    const std::size_t at = table_.at(int(batch_.x[i]), int(batch_.y[i]));
    __builtin_prefetch(&table_.leaving[at]);
    __builtin_prefetch(&table_.leaving[at + std::size_t(table_.size)]);
    __builtin_prefetch(&table_.cells[at]);
  }
  /// Lanes that are left over repeat the last search.
  void load(std::size_t first, std::size_t lanes) {
    for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
      const std::uint8_t i = busy_[first + std::min(lane, lanes - 1)];
      assert(table_.isFilled({batch_.x[i], batch_.y[i]}));
      lanes_.x[lane] = batch_.x[i];
      lanes_.y[lane] = batch_.y[i];
      for (int k = 0; k < 3; ++k) lanes_.point[k][lane] = batch_.point[k][i];
    }
  }

  /// Steps 2 and 3 for a lane that has been evaluated; true while its search goes on.
  bool advance(int lane, std::uint8_t i, bool isLast) {
    const int at = lanes_.nextCell[lane];
    const unsigned cell = at < 0 ? 0u : table_.cells[std::size_t(at)];
    const bool isShort = lanes_.isShort[lane] != 0;
    if (!isShort && !isLast && shortened_[i] < kMostShortened && moveOn(lane, i, cell)) return true;
    for (int k = 0; k < 3; ++k) batch_.mirror[k][i] = lanes_.mirror[k][lane];
    batch_.rest[i] = lanes_.rest[lane];
    const bool isInside =
        isShort && lanes_.isAhead[lane] != 0 && (cell & (RayTable::kRay << lanes_.nextCorner[lane])) != 0;
    batch_.isInside[i] = isInside ? 1 : 0;
    if (isInside && (cell & RayTable::kFilled) != 0) {
      batch_.x[i] = lanes_.nextX[lane];
      batch_.y[i] = lanes_.nextY[lane];
    }
    return false;
  }
  bool moveOn(int lane, std::uint8_t i, unsigned cell) {
    const vec2 p(lanes_.x[lane], lanes_.y[lane]);
    vec2 next(lanes_.nextX[lane], lanes_.nextY[lane]);
    if ((cell & RayTable::kFilled) == 0) {
      const vec2 step = next - p;
      float part = 1;
      for (int k = 0; k < kShortenings && !table_.isFilled(next); ++k) next = p + (part *= 0.5f) * step;
      if (!table_.isFilled(next)) return false;
      ++shortened_[i];
    }
    batch_.x[i] = next.x;
    batch_.y[i] = next.y;
    prefetch(i);
    return true;
  }

  const RayTable& table_;
  RayBatch& batch_;
  RayLanes lanes_;
  std::array<std::uint8_t, kMostSearches> busy_, shortened_;
  std::size_t busyCount_ = 0;
};

}  // namespace

void findRays(const RayTable& table, std::span<const std::uint8_t> which, RayBatch& batch) {
  assert(which.size() <= kMostSearches);
  if (!which.empty()) RaySearches(table, batch).run(which);
}

FoundRay findRay(const RayTable& table, const vec3& scenePoint, const vec2& texel) {
  RayBatch batch;
  for (int k = 0; k < 3; ++k) batch.point[k][0] = scenePoint[k];
  batch.x[0] = texel.x;
  batch.y[0] = texel.y;
  const std::uint8_t first = 0;
  findRays(table, std::span(&first, 1), batch);
  return {
      {batch.mirror[0][0], batch.mirror[1][0], batch.mirror[2][0]}, batch.rest[0], batch.isInside[0] != 0};
}

}  // namespace catoptric::reflection_morphing
