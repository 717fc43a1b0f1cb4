// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/lane_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/virtual_object/lane_map.h"
#include "catoptric/virtual_object/mesh_walk.h"
#include "catoptric/virtual_object/mirror_law_lanes.h"

namespace catoptric::virtual_object {
namespace {

using core::fromBits;
using core::toBits;

constexpr float kAlmostSine = 2e-3f;  // one more step leaves about the square of it
constexpr float kStaleSine = 0.1f;    // the maps know better than the last frame
constexpr float kGrazing = 0.02f;     // of h.n = 2 cos(angle of incidence): below it floats lose too much
constexpr float kWalkable = 1.0f;     // triangles away; beyond, the hidden map knows the way
constexpr int kMaxSteps = 8;          // more means that the start was bad
constexpr float kFarOutside = 0.5f;   // there the extrapolated mirror is no guide
constexpr int kMostStepsOutside = 1;  // there, unless they lead on
constexpr float kOutside = 1e-5f;     // barycentric slack
constexpr int kMostCrossings = 120;   // half round a finely cut mirror

struct Search {
  EightInts triangle;
  Eight u, v;
  Triangles t;
};

/// To where the eye sees a target on the mirror, without walking there: the hidden map names the triangle.
/// Returns the lanes in which it does; the others stay.
CATOPTRIC_INLINE EightInts jumpTo(const LaneView& view, const EightInts& which, const LaneVector& target,
                                  Search& s) {
  const MapPlace place = findPlace(view.hiddenMap, target);
  EightInts shown;
  for (int i = 0; i < kLanes; ++i) shown[i] = std::int32_t(view.hiddenIds[std::uint32_t(place.index[i])]);
  const EightInts isShown = which & place.isInside & (shown != std::int32_t(core::kNoId));
  s.triangle = isShown ? shown : s.triangle;
  gather(view.triangles, s.triangle, s.t);
  const LaneVector d = target - s.t.position0;
  const Eight a = dot(s.t.edge1, d), b = dot(s.t.edge2, d);
  const Eight u = larger(s.t.gram11 * a + s.t.gram12 * b, Eight{}),
              v = larger(s.t.gram12 * a + s.t.gram22 * b, Eight{});
  const Eight inside = 1.0f / larger(u + v, Eight{} + 1.0f);
  s.u = isShown ? u * inside : s.u;
  s.v = isShown ? v * inside : s.v;
  return isShown;
}

/// Step 1.
CATOPTRIC_INLINE void start(const LaneView& view, const LaneVector& local, Search& s) {
  const LaneVector d = local - broadcast(view.seedMap.centre);
  const Eight layer =
      (1.0f / squareRoot(larger(dot(d, d), Eight{} + 1e-30f)) - view.inverseNear) * view.layersPerInverse;
  const Eight nearWeight = 1.0f - smaller(larger(layer, Eight{}), Eight{} + 1.0f);
  const MapPlace place = findPlace(view.seedMap, local);
  static_assert(sizeof(SeedPixel) == sizeof(Eight));
  Eights seeds;
  for (int i = 0; i < kLanes; ++i) seeds[i] = load(&view.seeds[std::uint32_t(place.index[i])].nearPosition.x);
  core::transpose(seeds);
  EightInts nearTriangle, farTriangle;
  std::memcpy(&nearTriangle, &seeds[3], sizeof nearTriangle);
  std::memcpy(&farTriangle, &seeds[7], sizeof farTriangle);
  s.triangle = nearWeight >= 0.5f ? nearTriangle : farTriangle;
  const LaneVector near{{seeds[0], seeds[1], seeds[2]}}, far{{seeds[4], seeds[5], seeds[6]}};
  s.u = s.v = Eight{} + 1.0f / 3;
  static_cast<void>(
      jumpTo(view, ~EightInts{}, toLocal(view, nearWeight * near + (1.0f - nearWeight) * far), s));
}

/// Some lanes to where the maps say; false if there are none.
CATOPTRIC_INLINE bool restart(const LaneView& view, const EightInts& which, const LaneVector& local,
                              Search& s) {
  if (toBits(which) == 0) return false;
  Search fresh;
  start(view, local, fresh);
  s.triangle = which ? fresh.triangle : s.triangle;
  s.u = which ? fresh.u : s.u;
  s.v = which ? fresh.v : s.v;
  gather(view.triangles, s.triangle, s.t);
  return true;
}

/// Steps that leave their triangle, lane by lane.
struct Walk {
  LaneFloats u, v, stepU, stepV;
  std::uint32_t triangle[kLanes];
  unsigned stuck = 0;  ///< lanes that got nowhere
};

void walkAlone(std::span<const LaneTriangle> triangles, unsigned lanes, Walk& walk) {
  struct Place {
    std::uint32_t triangle;
    float u, v;
  };
  for (; lanes != 0; lanes &= lanes - 1) {
    const int i = std::countr_zero(lanes);
    Place at{walk.triangle[i], walk.u[i], walk.v[i]};
    if (!walkOverMesh(triangles, at, walk.stepU[i], walk.stepV[i], kMostCrossings) &&
        std::max({-at.u, -at.v, at.u + at.v - 1.0f}) <= 0)
      walk.stuck |= 1u << i;
    walk.triangle[i] = at.triangle, walk.u[i] = at.u, walk.v[i] = at.v;
  }
}

/// Step 3 for lanes whose step leaves the triangle; returns those that got nowhere.
CATOPTRIC_INLINE EightInts walkOn(const LaneView& view, const EightInts& leaving, const EightInts& last,
                                  const Law& law, Search& s) {
  const Eight u = s.u + law.stepU, v = s.v + law.stepV;
  const EightInts isFar = leaving & ~last & (outsideBy(u, v) >= kWalkable);
  EightInts walking = leaving;
  if (toBits(isFar) != 0) walking &= ~jumpTo(view, isFar, s.t.position0 + u * s.t.edge1 + v * s.t.edge2, s);
  Walk walk;
  store(walk.u, s.u), store(walk.v, s.v);
  store(walk.stepU, law.stepU), store(walk.stepV, law.stepV);
  std::memcpy(walk.triangle, &s.triangle, sizeof walk.triangle);
  walkAlone(view.triangles, toBits(walking), walk);
  s.u = load(walk.u), s.v = load(walk.v);
  std::memcpy(&s.triangle, walk.triangle, sizeof walk.triangle);
  gather(view.triangles, s.triangle, s.t);
  return fromBits(walk.stuck);
}

/// Step 1: at the places of the last frame, those without one at the maps' place.
CATOPTRIC_INLINE Search begin(const LaneView& view, const LaneGroup& group, const LaneVector& local) {
  Search s;
  std::memcpy(&s.triangle, group.triangle, sizeof s.triangle);
  s.u = load(group.u), s.v = load(group.v);
  const EightInts isKnown = (s.triangle >= 0) & (s.triangle < std::int32_t(view.triangles.size()));
  s.triangle = isKnown ? s.triangle : EightInts{};
  if ((group.wanted & ~toBits(isKnown)) != 0)
    restart(view, ~isKnown, local, s);
  else
    gather(view.triangles, s.triangle, s.t);
  return s;
}

struct SearchLanes {
  CATOPTRIC_INLINE static void run(const LaneView& view, LaneGroup& group) {
    const LaneVector local = toLocal(view, loadVector(group.point)), eye = broadcast(view.eye);
    Search s = begin(view, group, local);
    EightInts active = fromBits(group.wanted), found{}, lost{}, hard{}, stepsOutside{};
    Eight lastSine = Eight{} + 4.0f;
    for (int step = 0; step < kMaxSteps && toBits(active) != 0; ++step) {
      Law law = evaluate(s.t, s.u, s.v, eye, local);  // 2
      if (step == 0 && restart(view, active & ~(law.squaredSine < kStaleSine * kStaleSine), local, s))
        law = evaluate(s.t, s.u, s.v, eye, local);
      const EightInts isLast = law.squaredSine < kAlmostSine * kAlmostSine;
      const EightInts isFar = outsideBy(s.u, s.v) > kFarOutside;
      stepsOutside -= isFar;
      const EightInts isEasy =
          (law.squaredSine < lastSine) & (law.facing > kGrazing) & (law.distance > view.touching);
      const EightInts findsNoRoot = ~isEasy | (step == kMaxSteps - 1 ? ~isLast : EightInts{});
      const EightInts isLost =
          active & findsNoRoot & isFar & (law.facing > 0.0f) & (stepsOutside > kMostStepsOutside);
      lost |= isLost;
      active &= ~isLost;
      hard |= active & ~isEasy;
      active &= isEasy;
      const Eight u = s.u + law.stepU, v = s.v + law.stepV, outside = outsideBy(u, v);
      const EightInts stays = active & (outside <= 0.0f), leaves = active & ~stays;
      s.u = stays ? u : s.u;
      s.v = stays ? v : s.v;
      if (toBits(leaves) != 0) {  // 3
        const EightInts stuck = walkOn(view, leaves, isLast, law, s);
        hard |= stuck;
        active &= ~stuck;
      }
      found |= active & isLast;
      active &= ~isLast;
      lastSine = law.squaredSine;
    }
    hard |= active;
    finish(view, s, local, eye, found, group);
    group.lost = toBits(lost), group.hard = toBits(hard);
  }

  CATOPTRIC_INLINE static void finish(const LaneView& view, const Search& s, const LaneVector& local,
                                      const LaneVector& eye, const EightInts& found, LaneGroup& group) {
    const LaneVector position = s.t.position0 + s.u * s.t.edge1 + s.v * s.t.edge2;
    const LaneVector toPosition = position - eye, onward = local - position;
    const Eight lengthening = squareRoot(dot(onward, onward) / dot(toPosition, toPosition));
    const LaneVector rest = broadcast(view.centreRest), centre = broadcast(view.centre);
    storeVector(group.position, (position + rest) + centre);
    storeVector(group.virtualPosition, ((position + lengthening * toPosition) + rest) + centre);
    group.found = toBits(found);
    std::memcpy(group.triangle, &s.triangle, sizeof group.triangle);
    store(group.u, s.u), store(group.v, s.v);
    group.isOutside = group.found & toBits(outsideBy(s.u, s.v) > kOutside);
    for (int i = 0; i < kLanes; ++i)
      if (view.triangles[std::uint32_t(s.triangle[i])].flags & MirrorTriangle::kSkirt)
        group.isOutside |= (1u << i) & group.found;
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

void searchLanes(const LaneView& view, LaneGroup& group) {
  core::runOnWidestVectors<SearchLanes>(view, group);
}

LaneLaw evaluateLanes(const LaneView& view, const LaneGroup& group) {
  LaneLaw out;
  core::runOnWidestVectors<EvaluateLanes>(view, group, out);
  return out;
}

}  // namespace catoptric::virtual_object
