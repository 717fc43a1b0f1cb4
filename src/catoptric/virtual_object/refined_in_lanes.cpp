// SPDX-License-Identifier: Apache-2.0
// Refined, eight vertices side by side, for convex mirrors (virtual_object_solver.h): what a frame's time
// depends on.
//
//   1. Surely hidden by the mirror? Then no search.
//   2. The others are searched together (lane_search.h).
//   3. What is not easy goes to the double search, from where it was found last or from its own seed.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "catoptric/virtual_object/lane_search.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kTouching = 4e-3;  // of the mesh's radius: nearer points need doubles

template <class Function>
void forEachLane(unsigned lanes, const Function& function) {
  for (; lanes != 0; lanes &= lanes - 1) function(std::size_t(std::countr_zero(lanes)));
}

vec3 laneOf(const LaneFloats (&vector)[3], std::size_t lane) {
  return {vector[0][lane], vector[1][lane], vector[2][lane]};
}

}  // namespace

void VirtualObjectSolver::prepareLanes() {
  const dvec3 centre = mesh_->centre();
  LaneView& view = laneView_;
  view.triangles = laneTriangles_;
  view.centre = vec3(centre);
  view.centreRest = vec3(centre - dvec3(view.centre));
  view.eye = vec3(eye_ - centre);
  const auto mapOf = [](const MapFrame& frame, const vec3& middle, const dvec2& lower, const dvec2& scale,
                        int size) {
    return LaneMap{middle, vec3(frame.x), vec3(frame.y), vec3(frame.z), vec2(lower), vec2(scale), size};
  };
  const int seeds = seedMap_.pixels.width();
  view.hiddenMap =
      mapOf(hiddenMap_.frame, view.eye, hiddenMap_.lower, hiddenMap_.pixelsPerUnit, hiddenMap_.ids.width());
  view.seedMap = mapOf(nearMap_.frame, vec3(nearMap_.centre - centre), dvec2(-1), dvec2(0.5 * seeds), seeds);
  view.hiddenIds = hiddenMap_.ids.pixels();
  findSurelyHiding(hiddenMap_.ids, surelyHiding_);
  view.surelyHiding = surelyHiding_;
  view.seeds = seedMap_.pixels.pixels();
  view.hiddenNearest = float(hiddenMap_.nearest);
  view.hiddenSquaredCosine = float(hiddenMap_.squaredCosine);
  view.inverseNear = float(inverseNear_), view.layersPerInverse = float(layersPerInverse_);
  view.touching = float(kTouching * mesh_->radius());
}

void VirtualObjectSolver::solveGroup(const VertexSink& sink, std::size_t first, std::size_t count) const {
  LaneGroup group;
  LanePlaces* places = sink.places;
  for (std::size_t lane = 0; lane < std::size_t(kLanes); ++lane) {
    const vec3& point = sink.scenePoints[first + std::min(lane, count - 1)];
    for (int k = 0; k < 3; ++k) group.point[k][lane] = point[k];
    const bool isKnown = places != nullptr && lane < count;
    group.triangle[lane] = isKnown ? places->triangles[first + lane] : -1;
    group.u[lane] = isKnown ? places->u[first + lane] : 0.0f;
    group.v[lane] = isKnown ? places->v[first + lane] : 0.0f;
    if (lane >= count) continue;
    if (std::isfinite(point.x + point.y + point.z))
      group.wanted |= 1u << lane;
    else
      sink.write(first + lane, VirtualVertex{});
  }
  const auto write = [&](std::size_t lane, VertexKind kind) {
    sink.write(first + lane, laneOf(group.virtualPosition, lane), laneOf(group.position, lane), kind);
  };
  // 1
  hideLanes(laneView_, group);
  forEachLane(group.hidden, [&](std::size_t lane) { write(lane, VertexKind::DoublyVirtual); });
  group.wanted &= ~group.hidden;
  if (group.wanted == 0) return;
  // 2
  searchLanes(laneView_, group);
  forEachLane(group.found, [&](std::size_t lane) {
    write(lane, (group.isOutside >> lane & 1u) != 0 ? VertexKind::PastBoundary : VertexKind::Reflected);
  });
  if (places != nullptr)
    for (std::size_t lane = 0; lane < count; ++lane) {
      const bool isFound = (group.found >> lane & 1u) != 0, isHard = (group.hard >> lane & 1u) != 0;
      if (isHard) continue;
      places->triangles[first + lane] = isFound ? group.triangle[lane] : -1;
      places->u[first + lane] = group.u[lane], places->v[first + lane] = group.v[lane];
    }
  forEachLane(group.lost, [&](std::size_t lane) {
    const dvec3 point(sink.scenePoints[first + lane]);
    if (const auto hiding = findHidingPoint(point, false))
      sink.write(first + lane, mirrorHidden(*hiding, point));
    else
      write(lane, VertexKind::DoublyVirtual);
  });
  // 3
  forEachLane(group.hard, [&](std::size_t lane) { solveHard(sink, first + lane); });
}

void VirtualObjectSolver::solveHard(const VertexSink& sink, std::size_t i) const {
  const dvec3 point(sink.scenePoints[i]);
  LanePlaces* places = sink.places;
  std::optional<VirtualVertex> vertex;
  if (places != nullptr && places->triangles[i] >= 0 &&
      std::size_t(places->triangles[i]) < laneTriangles_.size())
    vertex = solveFrom({std::uint32_t(places->triangles[i]), places->u[i], places->v[i]}, point);
  if (!vertex) {
    double nearWeight;
    const dvec2 coords = computeCoords(point, nearWeight);
    vertex = solveRefined(point, seedMap_.at(coords), nearWeight);
  }
  sink.write(i, vertex->checked());
  if (places == nullptr) return;
  places->triangles[i] = vertex->kind == VertexKind::Reflected ? std::int32_t(vertex->at.triangle) : -1;
  places->u[i] = float(vertex->at.u), places->v[i] = float(vertex->at.v);
}

void VirtualObjectSolver::computeInLanes(const VertexSink& sink, std::size_t begin, std::size_t end) const {
  for (std::size_t first = begin; first < end; first += kLanes)
    solveGroup(sink, first, std::min(end - first, std::size_t(kLanes)));
}

}  // namespace catoptric::virtual_object
