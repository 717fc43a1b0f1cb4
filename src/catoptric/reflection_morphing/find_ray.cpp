// SPDX-License-Identifier: Apache-2.0
// Which ray of a map passes through a scene point?
//
// In: a ray table, scene points (world), for each a texel whose ray passes near it. Out: the first mirror
// point on the ray through it, the length of the path from there to the point, and whether the ray is one of
// the trace.
//   1. Gauss-Newton on the interpolated table, eight searches side by side (ray_lanes.h). All searches make
//      their first step as they lie in the batch, unless they are few; then those that are not at their end
//      make the second one, closed up, and so on.
//   2. A step under a twelfth of a texel is taken on the linear map and is the last one: what it leaves is a
//      hundredth of it, more at the rim. One or two steps are usual.
//   3. A step that leaves the map is shortened to its edge; the second time the search ends there and the
//      last step is taken anyway, which continues the map linearly.
//
// Departures from 2004: the paper takes the nearest ray of the leaf; that is off by up to half the distance
// of two rays, several pixels. Failures: where several rays of one trace pass through Q (concave mirrors
// behind their focus) one of them is found. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/find_ray.h"

#include <algorithm>
#include <bit>

#include "catoptric/reflection_morphing/ray_lanes.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr int kMostSteps = 8;
constexpr int kShortenings = 5;

/// What RayTable::cells says of each lane's cell; 0 off the table.
CATOPTRIC_INLINE EightInts readCells(const RayTable& table, const EightInts& cell,
                                     const EightInts& isOnTable) {
  EightInts read;
  for (int i = 0; i < kLanes; ++i) read[i] = table.cells[std::size_t(cell[i])];
  return read & isOnTable;
}

CATOPTRIC_INLINE EightInts findFilledLanes(const RayTable& table, const Eight& x, const Eight& y) {
  const float end = float(table.size - 1);
  const EightInts isOnTable = (x >= 0.0f) & (y >= 0.0f) & (x < end) & (y < end);
  const Eight safeX = isOnTable ? x : Eight{}, safeY = isOnTable ? y : Eight{};
  const EightInts cell =
      __builtin_convertvector(safeY, EightInts) * table.size + __builtin_convertvector(safeX, EightInts);
  return (readCells(table, cell, isOnTable) & 1) != 0;
}

CATOPTRIC_INLINE void prefetch(const RayTable& table, float x, float y) {
  const std::size_t at = table.at(int(x), int(y));
  __builtin_prefetch(&table.leaving[at]);
  __builtin_prefetch(&table.leaving[at + std::size_t(table.size)]);
  __builtin_prefetch(&table.cells[at]);
}

/// Eight searches after a step.
struct Lanes {
  RayStep step;
  Eight x, y;            ///< where they stand now
  EightInts isInside;    ///< ended in a cell of the trace
  unsigned goOn, leave;  ///< a bit for each one that is to make another step, or whose step left the map
};

/// Step 2. A search that `isLast` ends here.
CATOPTRIC_INLINE Lanes advance(const RayTable& table, const Eight& x, const Eight& y, const Eight* point,
                               const EightInts& isLast) {
  static_assert(RayTable::kFilled == 1 && RayTable::kRay == 2);
  Lanes lanes;
  const RayStep& s = lanes.step = makeRayStep(table, x, y, point);
  const EightInts cell = readCells(table, s.cell, s.isOnTable), isFilled = (cell & 1) != 0;
  const EightInts isLong = ~s.isShort & ~isLast;
  lanes.isInside = s.isShort & s.isAhead & (((cell >> (s.corner + 1)) & 1) != 0);
  const EightInts moves = isFilled & (isLong | lanes.isInside);
  lanes.x = moves ? s.x : x;
  lanes.y = moves ? s.y : y;
  lanes.goOn = toBits(isLong & isFilled);
  lanes.leave = toBits(isLong & ~isFilled);
  return lanes;
}

/// In how many eights of the batch there are some.
inline std::size_t countEights(SearchSet which) {
  std::size_t count = 0;
  for (; which != 0; which >>= kLanes) count += (which & 0xffu) != 0 ? 1 : 0;
  return count;
}

/// The searches that are under way.
class Searches {
 public:
  Searches(const RayTable& table, int mostShortened, RayBatch& batch)
      : table_(table), batch_(batch), mostShortened_(mostShortened), edge_(mostShortened > 0 ? ~0u : 0u) {}

  CATOPTRIC_INLINE SearchSet run(SearchSet which) {
    for (SearchSet rest = which; rest != 0; rest &= rest - 1) {
      const auto i = std::size_t(std::countr_zero(rest));
      prefetch(table_, batch_.x[i], batch_.y[i]);
    }
    shortened_.fill(0);
    const bool isSparse = 2 * std::size_t(std::popcount(which)) < kLanes * countEights(which);
    if (isSparse) forEachSearch(which, [&](std::size_t i) { busy_[busyCount_++] = std::uint8_t(i); });
    for (std::size_t first = 0; first < kMostSearches && !isSparse; first += kLanes)
      if (const auto active = unsigned(which >> first & 0xffu); active != 0) beginEight(first, active);
    for (int step = isSparse ? 0 : 1; busyCount_ > 0; ++step) {
      const std::size_t count = busyCount_;
      busyCount_ = 0;
      for (std::size_t first = 0; first < count; first += kLanes)
        goOnEight(first, std::min(count - first, std::size_t(kLanes)), step == kMostSteps);
    }
    return inside_;
  }

 private:
  /// Searches that follow each other in the batch; those that are not `active` keep what they have.
  CATOPTRIC_INLINE void beginEight(std::size_t first, unsigned active) {
    const EightInts isActive = fromBits(active);
    const Eight x = load(&batch_.x[first]), y = load(&batch_.y[first]);
    const Eight point[3] = {load(&batch_.point[0][first]), load(&batch_.point[1][first]),
                            load(&batch_.point[2][first])};
    const Lanes lanes = advance(table_, isActive ? x : Eight{}, isActive ? y : Eight{}, point, EightInts{});
    const auto put = [&](const Eight& value, RayBatch::Floats& to) __attribute__((always_inline)) {
      store(&to[first], isActive ? value : load(&to[first]));
    };
    put(lanes.x, batch_.x), put(lanes.y, batch_.y), put(lanes.step.rest, batch_.rest);
    for (int k = 0; k < 3; ++k) put(lanes.step.mirror[k], batch_.mirror[k]);
    inside_ |= SearchSet(toBits(lanes.isInside) & active) << first;
    for (unsigned lane = 0; lane < kLanes; ++lane)
      if (((lanes.goOn | (lanes.leave & edge_)) & active) >> lane & 1u)
        followUp(lanes, lane, std::uint8_t(first + lane));
  }

  /// Searches first to first + count of those that are under way.
  CATOPTRIC_INLINE void goOnEight(std::size_t first, std::size_t count, bool areLast) {
    Eight x, y, point[3];
    EightInts isLast{};
    std::uint8_t which[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint8_t i = which[lane] = busy_[first + std::min(lane, count - 1)];
      x[lane] = batch_.x[i];
      y[lane] = batch_.y[i];
      for (int k = 0; k < 3; ++k) point[k][lane] = batch_.point[k][i];
      isLast[lane] = areLast || (shortened_[i] == mostShortened_ && mostShortened_ > 0) ? -1 : 0;
    }
    const Lanes lanes = advance(table_, x, y, point, isLast);
    const unsigned inside = toBits(lanes.isInside);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::uint8_t i = which[lane];
      batch_.x[i] = lanes.x[lane];
      batch_.y[i] = lanes.y[lane];
      batch_.rest[i] = lanes.step.rest[lane];
      for (int k = 0; k < 3; ++k) batch_.mirror[k][i] = lanes.step.mirror[k][lane];
      inside_ |= SearchSet(inside >> lane & 1u) << i;
      if (((lanes.goOn | (lanes.leave & edge_)) >> lane & 1u) != 0) followUp(lanes, unsigned(lane), i);
    }
  }

  CATOPTRIC_INLINE void followUp(const Lanes& lanes, unsigned lane, std::uint8_t i) {
    if ((lanes.leave >> lane & 1u) != 0 && !shorten(i, {lanes.step.x[lane], lanes.step.y[lane]})) return;
    busy_[busyCount_++] = i;
    prefetch(table_, batch_.x[i], batch_.y[i]);
  }

  /// Step 3; false where the search ends. `next`: where its step would lead. All that may be left of the step
  /// are tried side by side.
  CATOPTRIC_INLINE bool shorten(std::size_t i, const vec2& next) {
    const Eight part{0.5f, 0.25f, 0.125f, 0.0625f, 0.03125f};
    const Eight x = batch_.x[i] + (next.x - batch_.x[i]) * part,
                y = batch_.y[i] + (next.y - batch_.y[i]) * part;
    const unsigned filled = toBits(findFilledLanes(table_, x, y)) & ((1u << kShortenings) - 1);
    if (filled == 0) return false;
    const int longest = std::countr_zero(filled);
    ++shortened_[i];
    batch_.x[i] = x[longest];
    batch_.y[i] = y[longest];
    return true;
  }

  const RayTable& table_;
  RayBatch& batch_;
  int mostShortened_;
  unsigned edge_;  ///< the lanes that may go on from there
  SearchSet inside_ = 0;
  std::array<std::uint8_t, kMostSearches> busy_, shortened_;
  std::size_t busyCount_ = 0;
};

struct FindRays {
  CATOPTRIC_INLINE static void run(const RayTable& table, const SearchSet& which, const int& mostShortened,
                                   RayBatch& batch, SearchSet& inside) {
    inside = Searches(table, mostShortened, batch).run(which);
  }
};

struct FindFilled {
  CATOPTRIC_INLINE static void run(const RayTable& table, const RayBatch& batch, SearchSet& filled) {
    for (std::size_t first = 0; first < kMostSearches; first += kLanes) {
      const EightInts isFilled = findFilledLanes(table, load(&batch.x[first]), load(&batch.y[first]));
      filled |= SearchSet(toBits(isFilled)) << first;
    }
  }
};

}  // namespace

SearchSet findRays(const RayTable& table, SearchSet which, int mostShortened, RayBatch& batch) {
  SearchSet inside = 0;
  if (which != 0) core::runOnWidestVectors<FindRays>(table, which, mostShortened, batch, inside);
  return inside;
}

SearchSet findFilled(const RayTable& table, SearchSet which, const RayBatch& batch) {
  SearchSet filled = 0;
  core::runOnWidestVectors<FindFilled>(table, batch, filled);
  return filled & which;
}

FoundRay findRay(const RayTable& table, const vec3& scenePoint, const vec2& texel) {
  RayBatch batch;
  for (int k = 0; k < 3; ++k) batch.point[k][0] = scenePoint[k];
  batch.x[0] = texel.x;
  batch.y[0] = texel.y;
  const bool isInside = findRays(table, 1, kMostShortened, batch) != 0;
  return {{batch.mirror[0][0], batch.mirror[1][0], batch.mirror[2][0]}, batch.rest[0], isInside};
}

}  // namespace catoptric::reflection_morphing
