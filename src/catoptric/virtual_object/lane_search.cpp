// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/lane_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/virtual_object/lane_seed.h"
#include "catoptric/virtual_object/mesh_walk.h"
#include "catoptric/virtual_object/mirror_law_lanes.h"
#include "catoptric/virtual_object/reflection_point.h"

namespace catoptric::virtual_object {
namespace {

using core::fromBits;
using core::toBits;

constexpr float kAlmostSine = 2e-3f;  // one more step leaves about the square of it
constexpr float kStale = 0.1f;        // of h's part across the normal: the maps know better
constexpr float kGrazing = 0.02f;     // of h.n = 2 cos(angle of incidence): below it floats lose too much
constexpr auto kStraight = float(MirrorLaw::kStraight);
constexpr auto kShorter = float(search_limits::kShorter);
constexpr auto kFarOutside = float(search_limits::kFarOutside);
constexpr float kAsBefore = 0.8f;   // of how much the law failed
constexpr int kMostShortened = 4;   // in a row; then onwards all the same
constexpr int kMaxSteps = 12;       // more means that the start was bad
constexpr int kStepsBehind = 5;     // then a search that is on the back stays there
constexpr float kOutside = 1e-5f;   // barycentric slack
constexpr int kMostCrossings = 16;  // of edges in one step; the next one goes on

/// As LaneState, and what became of the lanes.
struct Search {
  Places at, last;
  Triangles t;  ///< of `at`
  Eight stepU, stepV, merit;
  EightInts steps, stepsOutside, shortened;
  Eight lostBy;
  EightInts active, found{}, lost{}, hard{};
};

/// Some lanes to where the maps say.
CATOPTRIC_INLINE void restart(const LaneView& view, const EightInts& which, const LaneVector& local,
                              Search& s) {
  s.at = choose(which, seed(view, local), s.at);
  gather(view.triangles, s.at.triangle, s.t);
}

/// Steps that leave their triangle, lane by lane.
struct Walk {
  LaneFloats u, v, stepU, stepV;
  std::uint32_t triangle[kLanes];
};

void walkAlone(std::span<const LaneTriangle> triangles, unsigned lanes, Walk& walk) {
  struct Place {
    std::uint32_t triangle;
    float u, v;
  };
  for (; lanes != 0; lanes &= lanes - 1) {
    const int i = std::countr_zero(lanes);
    Place at{walk.triangle[i], walk.u[i], walk.v[i]};
    static_cast<void>(walkOverMesh(triangles, at, walk.stepU[i], walk.stepV[i], kMostCrossings));
    walk.triangle[i] = at.triangle, walk.u[i] = at.u, walk.v[i] = at.v;
  }
}

/// Step 3.
CATOPTRIC_INLINE void walkOn(const LaneView& view, const EightInts& which, Search& s) {
  const LaneVector move = s.stepU * s.t.edge1 + s.stepV * s.t.edge2;
  const Eight length = squareRoot(dot(move, move));
  const Eight share = length > view.longestStep ? view.longestStep / length : Eight{} + 1.0f;
  s.stepU = share * s.stepU, s.stepV = share * s.stepV;
  Walk walk;
  store(walk.u, s.at.u), store(walk.v, s.at.v);
  store(walk.stepU, s.stepU), store(walk.stepV, s.stepV);
  std::memcpy(walk.triangle, &s.at.triangle, sizeof walk.triangle);
  walkAlone(view.triangles, toBits(which), walk);
  s.at.u = load(walk.u), s.at.v = load(walk.v);
  std::memcpy(&s.at.triangle, walk.triangle, sizeof walk.triangle);
  gather(view.triangles, s.at.triangle, s.t);
}

template <class Value>
CATOPTRIC_INLINE Value loadAs(const void* from) {
  Value value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class Value>
CATOPTRIC_INLINE void storeAs(void* to, const Value& value) {
  std::memcpy(to, &value, sizeof value);
}

CATOPTRIC_INLINE Search resume(const LaneGroup& group) {
  Search s;
  s.active = fromBits(group.wanted), s.lostBy = load(group.lostBy);
  s.at = {loadAs<EightInts>(group.triangle), load(group.u), load(group.v)};
  s.stepU = s.stepV = s.merit = Eight{};
  s.last = s.at;
  s.steps = s.stepsOutside = s.shortened = EightInts{};
  if (!group.hasBegun) return s;
  const LaneState& from = group.state;
  s.last = {loadAs<EightInts>(from.triangle), load(from.u), load(from.v)};
  s.stepU = load(from.stepU), s.stepV = load(from.stepV), s.merit = load(from.merit);
  s.steps = loadAs<EightInts>(from.steps), s.stepsOutside = loadAs<EightInts>(from.stepsOutside);
  s.shortened = loadAs<EightInts>(from.shortened);
  return s;
}

struct SearchLanes {
  CATOPTRIC_INLINE static void run(const LaneView& view, LaneGroup& group, int fewest) {
    const LaneVector local = toLocal(view, loadVector(group.point)), eye = broadcast(view.eye);
    Search s = resume(group);
    // Step 1: at the places of the last frame, those without one and stale ones at the maps' place.
    const EightInts isKnown = (s.at.triangle >= 0) & (s.at.triangle < std::int32_t(view.triangles.size()));
    s.at.triangle = isKnown ? s.at.triangle : EightInts{};
    gather(view.triangles, s.at.triangle, s.t);
    EightInts isSeeded = s.active & ~isKnown, mayBeStale = s.active & isKnown & (s.steps == 0);
    for (;;) {
      if (toBits(isSeeded) != 0) restart(view, isSeeded, local, s);
      const Law law = evaluate(s.t, s.at.u, s.at.v, eye, local);
      const EightInts isMet = law.distance <= view.contact;
      const EightInts wasLost = mayBeStale & (s.lostBy != 0.0f);
      if (toBits(wasLost) != 0) loseAgain(wasLost, law, eye, local, s);
      const EightInts isFresh = law.squaredSine * law.squaredHalf < kStale * kStale;
      isSeeded = mayBeStale & s.active & ~isMet & ~(isFresh & ~wasLost);
      mayBeStale = EightInts{};
      if (toBits(isSeeded) != 0) continue;
      s.steps -= s.active;
      const EightInts isLast = law.squaredSine < kAlmostSine * kAlmostSine;
      if (toBits(s.active & isMet) != 0) meet(isMet, eye, s);
      giveUp(view, law, isLast, s);
      step(view, law, isLast, s);
      s.found |= s.active & isLast;
      s.active &= ~isLast;
      if (std::popcount(toBits(s.active)) <= fewest) break;
    }
    finish(view, s, local, eye, group);
  }

  /// Points on the mirror: the law has no meaning there, and they are seen where they are.
  CATOPTRIC_INLINE static void meet(const EightInts& isMet, const LaneVector& eye, Search& s) {
    const EightInts isSeen = facesEye(s, s.at.u, s.at.v, eye);
    s.found |= s.active & isMet & isSeen, s.lost |= s.active & isMet & ~isSeen;
    s.lostBy = isMet & ~isSeen ? Eight{} - 1e-20f : s.lostBy;
    s.active &= ~isMet;
  }

  CATOPTRIC_INLINE static EightInts facesEye(const Search& s, const Eight& u, const Eight& v,
                                             const LaneVector& eye) {
    const LaneVector position = s.t.position0 + u * s.t.edge1 + v * s.t.edge2,
                     normal = s.t.normal0 + u * s.t.normal1 + v * s.t.normal2;
    return dot(normal, eye - position) > 0.0f;
  }

  /// What was lost is so still if the ray to the point enters the mirror in that triangle, or if the law
  /// fails there as it did and Newton's step does not lead back from far outside. If not, its place is no
  /// good start: a root on the back would hold it.
  CATOPTRIC_INLINE static void loseAgain(const EightInts& which, const Law& law, const LaneVector& eye,
                                         const LaneVector& local, Search& s) {
    const Eight u = s.at.u + law.stepU, v = s.at.v + law.stepV;
    const Eight past0 = smaller(-s.at.v, -v), past1 = smaller(s.at.u + s.at.v, u + v) - 1.0f,
                past2 = smaller(-s.at.u, -u);
    const Eight ratio = failure(law) / s.lostBy;
    const EightInts isAstray = (ratio > kAsBefore) & (ratio < 1.0f / kAsBefore) &
                               (larger(larger(past0, past1), past2) > kFarOutside);
    const PlaneMeeting met = meetPlane(s.t, eye, local - eye);
    const EightInts enters = (met.fraction > 0.0f) & (met.fraction < 1.0f) &
                             (outsideBy(met.u, met.v) <= 0.0f) & facesEye(s, met.u, met.v, eye);
    s.at.u = which & enters ? met.u : s.at.u, s.at.v = which & enters ? met.v : s.at.v;
    s.lost |= which & (isAstray | enters);
    s.active &= ~s.lost;
  }

  /// As LanePlace::lostBy.
  CATOPTRIC_INLINE static Eight failure(const Law& law) {
    const Eight across = larger(squareRoot(law.squaredSine * law.squaredHalf), Eight{} + 1e-20f);
    return law.facing < 0.0f ? -across : across;
  }

  /// Steps 4 and 5.
  CATOPTRIC_INLINE static void giveUp(const LaneView& view, const Law& law, const EightInts& isLast,
                                      Search& s) {
    const EightInts isFar = outsideBy(s.at.u, s.at.v) > kFarOutside;
    s.stepsOutside -= s.active & isFar;
    const EightInts isBehind = (law.facing < 0.0f) & (isLast | (s.steps > kStepsBehind));
    const EightInts isAstray = ~isLast & isFar & (s.stepsOutside > search_limits::kMostStepsOutside);
    const EightInts isStraight = law.squaredHalf < kStraight * kStraight;
    const EightInts isLost = s.active & (isStraight | isBehind | isAstray);
    s.lost |= isLost;
    s.lostBy = isLost ? failure(law) : s.lostBy;
    const EightInts isHard =
        (isLast ? law.facing <= kGrazing : s.steps >= kMaxSteps) | ~(law.distance > view.touching);
    s.hard |= s.active & ~isLost & isHard;
    s.active &= ~(isLost | isHard);
  }

  /// Newton's, or less of the last one if that made it worse.
  CATOPTRIC_INLINE static void step(const LaneView& view, const Law& law, const EightInts& isLast,
                                    Search& s) {
    const EightInts goesBack =
        s.active & ~isLast & (s.steps > 1) & ~(law.squaredMerit < s.merit) & (s.shortened < kMostShortened);
    if (toBits(goesBack) != 0) {
      s.at = choose(goesBack, s.last, s.at);
      gather(view.triangles, s.at.triangle, s.t);
    }
    s.stepU = goesBack ? kShorter * s.stepU : law.stepU;
    s.stepV = goesBack ? kShorter * s.stepV : law.stepV;
    s.merit = goesBack ? s.merit : law.squaredMerit;
    s.shortened = goesBack ? s.shortened + 1 : EightInts{};
    s.last = s.at;
    const Eight u = s.at.u + s.stepU, v = s.at.v + s.stepV;
    const EightInts isPastEnd = outsideBy(s.at.u, s.at.v) > kOutside;
    const EightInts stays = s.active & ((outsideBy(u, v) <= 0.0f) | (isLast & isPastEnd));
    s.at.u = stays ? u : s.at.u;
    s.at.v = stays ? v : s.at.v;
    const EightInts leaves = s.active & ~stays;
    if (toBits(leaves) != 0) walkOn(view, leaves, s);
  }

  CATOPTRIC_INLINE static void finish(const LaneView& view, const Search& s, const LaneVector& local,
                                      const LaneVector& eye, LaneGroup& group) {
    const LaneVector position = s.t.position0 + s.at.u * s.t.edge1 + s.at.v * s.t.edge2;
    const LaneVector toPosition = position - eye, onward = local - position;
    const Eight lengthening = squareRoot(dot(onward, onward) / dot(toPosition, toPosition));
    const LaneVector rest = broadcast(view.centreRest), centre = broadcast(view.centre);
    storeVector(group.position, (position + rest) + centre);
    storeVector(group.virtualPosition, ((position + lengthening * toPosition) + rest) + centre);
    storeAs(group.triangle, s.at.triangle), store(group.u, s.at.u), store(group.v, s.at.v);
    store(group.lostBy, s.lostBy);
    group.found = toBits(s.found), group.lost = toBits(s.lost), group.hard = toBits(s.hard);
    group.goesOn = toBits(s.active);
    group.isOutside = group.found & toBits(outsideBy(s.at.u, s.at.v) > kOutside);
    for (int i = 0; i < kLanes; ++i)
      if (view.triangles[std::uint32_t(s.at.triangle[i])].flags & MirrorTriangle::kSkirt)
        group.isOutside |= (1u << i) & group.found;
    if (group.goesOn == 0) return;
    LaneState& state = group.state;
    storeAs(state.triangle, s.last.triangle), store(state.u, s.last.u), store(state.v, s.last.v);
    store(state.stepU, s.stepU), store(state.stepV, s.stepV), store(state.merit, s.merit);
    storeAs(state.steps, s.steps), storeAs(state.stepsOutside, s.stepsOutside);
    storeAs(state.shortened, s.shortened);
  }
};

struct EvaluateLanes {
  CATOPTRIC_INLINE static void run(const LaneView& view, const LaneGroup& group, LaneLaw& out) {
    EightInts triangle;
    std::memcpy(&triangle, group.triangle, sizeof triangle);
    Triangles t;
    gather(view.triangles, triangle, t);
    const Law law = evaluate(t, load(group.u), load(group.v), broadcast(view.eye),
                             toLocal(view, loadVector(group.point)));
    store(out.squaredSine, law.squaredSine), store(out.facing, law.facing), store(out.distance, law.distance);
    store(out.stepU, law.stepU), store(out.stepV, law.stepV);
  }
};

}  // namespace

std::vector<LaneTriangle> makeLaneTriangles(const ReflectorMesh& mesh) {
  std::vector<LaneTriangle> lanes;
  lanes.reserve(mesh.triangles().size());
  for (const MirrorTriangle& t : mesh.triangles())
    lanes.push_back({vec3(t.position0 - mesh.centre()), vec3(t.edge1), vec3(t.edge2), vec3(t.normal0),
                     vec3(t.normal1), vec3(t.normal2), float(t.gram11), float(t.gram12), float(t.gram22),
                     t.neighbours, t.flags});
  return lanes;
}

void searchLanes(const LaneView& view, LaneGroup& group, int fewest) {
  core::runOnWidestVectors<SearchLanes>(view, group, fewest);
}

void moveLane(const LaneGroup& from, std::size_t i, LaneGroup& to, std::size_t j) {
  for (int k = 0; k < 3; ++k) to.point[k][j] = from.point[k][i];
  to.vertex[j] = from.vertex[i];
  to.triangle[j] = from.triangle[i], to.u[j] = from.u[i], to.v[j] = from.v[i];
  to.lostBy[j] = from.lostBy[i];
  const LaneState& a = from.state;
  LaneState& b = to.state;
  b.triangle[j] = a.triangle[i], b.u[j] = a.u[i], b.v[j] = a.v[i];
  b.stepU[j] = a.stepU[i], b.stepV[j] = a.stepV[i], b.merit[j] = a.merit[i];
  b.steps[j] = a.steps[i], b.stepsOutside[j] = a.stepsOutside[i], b.shortened[j] = a.shortened[i];
}

LaneLaw evaluateLanes(const LaneView& view, const LaneGroup& group) {
  LaneLaw out;
  core::runOnWidestVectors<EvaluateLanes>(view, group, out);
  return out;
}

}  // namespace catoptric::virtual_object
