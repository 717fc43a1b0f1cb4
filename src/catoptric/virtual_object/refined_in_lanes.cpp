// SPDX-License-Identifier: Apache-2.0
// Refined, eight vertices side by side, for convex mirrors (virtual_object_solver.h): what a frame's time
// depends on.
//
//   1. A chunk of vertices is dealt to eight lanes, a run of neighbours to each; a lane works through its
//      run.
//   2. Start: hidden by the mirror? Then no search. Else from the predecessor's reflection point if that is
//      near, else from the seed map, as the double search does.
//   3. All lanes are evaluated at once (mirror_law_lanes.h). A lane whose residual is small takes one last
//      step and is done: Newton's error goes with the square, so the step makes it vanish. Another takes its
//      step and goes on.
//   4. Whatever is not easy - nearly touching the mirror, grazing, past the mirror's edge, no quick
//      convergence - goes to the double search from its own seed. So what is found, and for which vertices,
//      is what that one finds.
#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/virtual_object/mirror_law_lanes.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

constexpr float kAlmostSine = 2e-3f;  // one more step leaves about the square of it
constexpr float kGrazing = 0.1f;      // of h.n = 2 cos(angle of incidence): below it floats lose too much
constexpr double kTouching = 4e-3;    // of the mesh's radius: nearer points need doubles
constexpr float kWalkable = 1.0f;     // triangles away; beyond, the hidden map knows the way
constexpr int kMaxSteps = 6;          // more means that the start was bad
constexpr float kNearPredecessor = 0.02f;  // squared angle between two vertices as seen from the mirror

}  // namespace

/// One lane's way through its run of vertices.
struct VirtualObjectSolver::LaneRun {
  std::size_t next = 0, end = 0;  ///< vertices still to come
  std::size_t current = 0;
  LanePoint at;
  float lastSine = 0;  ///< squared
  int steps = 0;
  bool isActive = false;
  bool hasPredecessor = false;
  vec3 point{0},
      position{0};  ///< of the current vertex and of the last reflection point, around the mirror's centre
};

/// False where the point surely lies in front of the mirror or beside it; cheaper than findHidingPoint().
bool VirtualObjectSolver::mayBeHidden(const vec3& local) const {
  constexpr float kSlack = 1e-4f;      // for the floats
  constexpr float kPixelDepth = 0.1f;  // by how much a pixel of the map may be nearer than its middle
  const vec3 toPoint = local - laneView_.eye;
  const float along = glm::dot(toPoint, laneView_.z), squared = glm::dot(toPoint, toPoint);
  if (!(along > (1 - kSlack) * laneView_.nearest) ||
      !(along * along > (laneView_.squaredCosine - kSlack) * squared))
    return false;
  const vec2 px = laneView_.pixelOf(local);
  const int n = hiddenMap_.ids.width();
  if (!(px.x >= 0 && px.y >= 0 && px.x < float(n) && px.y < float(n))) return false;
  const float distance = hiddenMap_.distances.at(int(px.x), int(px.y));  // infinite where the mirror is not
  return squared > (1 - kPixelDepth) * distance * distance;
}

/// To where the eye sees the target on the mirror, without walking there: the hidden map names the triangle.
/// False where the map shows none.
bool VirtualObjectSolver::jumpTo(LanePoint& at, const vec3& target) const {
  const vec2 px = laneView_.pixelOf(target);
  const int n = hiddenMap_.ids.width();
  if (!(px.x >= 0 && px.y >= 0 && px.x < float(n) && px.y < float(n))) return false;
  const std::uint32_t id = hiddenMap_.ids.at(int(px.x), int(px.y));
  if (id == core::kNoId) return false;
  const LaneTriangle& t = laneTriangles_[id];
  const vec3 d = target - t.position0;
  const float a = glm::dot(t.edge1, d), b = glm::dot(t.edge2, d);
  const float u = std::max(t.gram11 * a + t.gram12 * b, 0.0f),
              v = std::max(t.gram12 * a + t.gram22 * b, 0.0f);
  const float inside = 1.0f / std::max(u + v, 1.0f);
  at = {id, u * inside, v * inside};
  return true;
}

/// Step 2. Deals with vertices that need no search and stops at the first that does; false at the end of the
/// run.
bool VirtualObjectSolver::startLane(LaneRun& run, int lane, Lanes& lanes, const VertexSink& sink) const {
  while (run.next < run.end) {
    const std::size_t i = run.current = run.next++;
    const vec3 point = sink.scenePoints[i];
    if (!std::isfinite(point.x + point.y + point.z)) {
      sink.write(i, VirtualVertex{});
      continue;
    }
    const vec3 local(dvec3(point) - mesh_->centre());
    if (mayBeHidden(local))
      if (const auto hiding = findHidingPoint(dvec3(point), true)) {
        sink.write(i, mirrorHidden(*hiding, dvec3(point)));
        continue;
      }
    const vec3 moved = local - run.point, away = local - run.position;
    run.point = local;
    if (!run.hasPredecessor || !(glm::dot(moved, moved) < kNearPredecessor * glm::dot(away, away)))
      run.at = findLaneSeed(point);
    lanes.setTriangle(lane, laneTriangles_[run.at.triangle]);
    lanes.setPoint(lane, local);
    lanes.u[lane] = run.at.u, lanes.v[lane] = run.at.v;
    run.steps = 0;
    run.lastSine = 4.0f;
    return true;
  }
  return false;
}

/// As findSeed(): the blend of the two maps' points, on the mirror.
LanePoint VirtualObjectSolver::findLaneSeed(const vec3& scenePoint) const {
  double weight;
  const SeedPixel& seed = seedMap_.at(computeCoords(dvec3(scenePoint), weight));
  const float w = float(weight);
  LanePoint at{w >= 0.5f ? seed.nearTriangle : seed.farTriangle, 1.0f / 3, 1.0f / 3};
  static_cast<void>(
      jumpTo(at, w * seed.nearPosition + (1.0f - w) * seed.farPosition - vec3(mesh_->centre())));
  return at;
}

/// Step 4.
void VirtualObjectSolver::solveAlone(LaneRun& run, const VertexSink& sink) const {
  const dvec3 point(sink.scenePoints[run.current]);
  double nearWeight;
  const dvec2 coords = computeCoords(point, nearWeight);
  const VirtualVertex vertex = solveRefined(point, seedMap_.at(coords), nearWeight).checked();
  run.hasPredecessor = vertex.steps > 0;
  run.at = {vertex.at.triangle, float(vertex.at.u), float(vertex.at.v)};
  run.position = vec3(vertex.position - mesh_->centre());
  sink.write(run.current, vertex);
}

/// Step 3 for one lane after an evaluation: true when its vertex is done.
bool VirtualObjectSolver::advanceLane(LaneRun& run, int lane, Lanes& lanes, const VertexSink& sink) const {
  const float sine = lanes.squaredSine[lane], du = lanes.stepU[lane], dv = lanes.stepV[lane];
  const bool isLast = sine < kAlmostSine * kAlmostSine;
  const std::uint32_t before = run.at.triangle;
  const auto step = [&] {
    const float u = run.at.u + du, v = run.at.v + dv;
    if (isLast || std::max({-u, -v, u + v - 1.0f}) < kWalkable)
      return walkLane(laneTriangles_, run.at, du, dv);
    const LaneTriangle& t = laneTriangles_[before];
    return jumpTo(run.at, t.position0 + u * t.edge1 + v * t.edge2) ||
           walkLane(laneTriangles_, run.at, du, dv);
  };
  const bool isEasy = sine < run.lastSine && ++run.steps <= kMaxSteps && lanes.facing[lane] > kGrazing &&
                      lanes.distance[lane] > float(kTouching * mesh_->radius()) && step();
  if (!isEasy) {
    solveAlone(run, sink);
    return true;
  }
  const LaneTriangle& t = laneTriangles_[run.at.triangle];
  if (!isLast) {
    run.lastSine = sine;
    if (run.at.triangle != before) lanes.setTriangle(lane, t);
    lanes.u[lane] = run.at.u, lanes.v[lane] = run.at.v;
    return false;
  }
  run.hasPredecessor = true;
  run.position = t.position0 + run.at.u * t.edge1 + run.at.v * t.edge2;
  const vec3 toPosition = run.position - laneView_.eye, onward = run.point - run.position;
  const float lengthening = std::sqrt(glm::dot(onward, onward) / glm::dot(toPosition, toPosition));
  const bool isSkirt = (t.flags & MirrorTriangle::kSkirt) != 0;
  sink.write(run.current, vec3(mesh_->centre() + dvec3(run.position + lengthening * toPosition)),
             vec3(mesh_->centre() + dvec3(run.position)),
             isSkirt ? VertexKind::DoublyVirtual : VertexKind::Reflected);
  return true;
}

void VirtualObjectSolver::computeInLanes(const VertexSink& sink, std::size_t begin, std::size_t end) const {
  Lanes lanes{};
  std::array<LaneRun, kLanes> runs;
  const std::size_t share = (end - begin + kLanes - 1) / kLanes;
  int active = 0;
  for (int lane = 0; lane < kLanes; ++lane) {  // 1
    LaneRun& run = runs[std::size_t(lane)];
    run.next = std::min(begin + std::size_t(lane) * share, end);
    run.end = std::min(run.next + share, end);
    run.isActive = startLane(run, lane, lanes, sink);
    active += run.isActive;
  }
  while (active > 0) {
    evaluateLanes(lanes, laneView_.eye);
    for (int lane = 0; lane < kLanes; ++lane) {
      LaneRun& run = runs[std::size_t(lane)];
      if (!run.isActive || !advanceLane(run, lane, lanes, sink)) continue;
      run.isActive = startLane(run, lane, lanes, sink);
      active -= !run.isActive;
    }
  }
}

}  // namespace catoptric::virtual_object
