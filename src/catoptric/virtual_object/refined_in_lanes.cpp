// SPDX-License-Identifier: Apache-2.0
// Refined, eight vertices side by side, for convex mirrors (virtual_object_solver.h): what a frame's time
// depends on.
//
//   1. Surely hidden by the mirror? Then no search. What was seen last time is not asked: if it is hidden
//   now,
//      its search finds nothing, for a convex mirror lies behind the tangent plane of every root.
//   2. The others are searched together (lane_search.h), until only a few of eight go on.
//   3. These wait for others of their kind, and go on together.
//   What is not easy goes to the double search, from where it was found last or from its own seed.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "catoptric/virtual_object/lane_search.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kTouching = 4e-3, kContact = 1e-5;  // of the mesh's radius

constexpr int kStragglers = 3;  // of eight lanes: so few are not worth a step of all

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
  view.contact = float(kContact * mesh_->radius());
  view.longestStep = float(options_.longestStep * mesh_->radius());
}

/// Up to eight vertices as a group.
void VirtualObjectSolver::gatherGroup(const VertexSink& sink, std::span<const std::uint32_t> vertices,
                                      LaneGroup& group) {
  float sum = 0;
  for (std::size_t lane = 0; lane < std::size_t(kLanes); ++lane) {
    const std::size_t i = vertices[std::min(lane, vertices.size() - 1)];
    group.vertex[lane] = i;
    const vec3& point = sink.scenePoints[i];
    for (int k = 0; k < 3; ++k) group.point[k][lane] = point[k];
    sum += point.x + point.y + point.z;
    const LanePlace place = sink.places != nullptr ? (*sink.places)[i] : LanePlace{};
    group.triangle[lane] = place.triangle, group.u[lane] = place.u, group.v[lane] = place.v;
  }
  group.wanted = (1u << vertices.size()) - 1;
  if (std::isfinite(sum)) return;
  for (std::size_t lane = 0; lane < vertices.size(); ++lane) {
    const vec3& point = sink.scenePoints[vertices[lane]];
    if (std::isfinite(point.x + point.y + point.z)) continue;
    group.wanted &= ~(1u << lane);
    sink.write(vertices[lane], VirtualVertex{});
  }
}

/// What searchLanes() says, and the double search of what is hard.
void VirtualObjectSolver::conclude(const VertexSink& sink, const LaneGroup& group) const {
  const auto write = [&](std::size_t lane, VertexKind kind) {
    sink.write(group.vertex[lane], laneOf(group.virtualPosition, lane), laneOf(group.position, lane), kind);
  };
  const auto isOutside = [&](std::size_t lane) { return (group.isOutside >> lane & 1u) != 0; };
  forEachLane(group.found, [&](std::size_t lane) {
    write(lane, isOutside(lane) ? VertexKind::PastBoundary : VertexKind::Reflected);
  });
  if (sink.places != nullptr)
    forEachLane(group.found | group.lost, [&](std::size_t lane) {
      const bool isFound = (group.found >> lane & 1u) != 0;
      (*sink.places)[group.vertex[lane]] = {isFound ? group.triangle[lane] : -1, group.u[lane],
                                            group.v[lane]};
    });
  forEachLane(group.lost, [&](std::size_t lane) {
    const dvec3 point(sink.scenePoints[group.vertex[lane]]);
    const SurfacePoint at{std::uint32_t(group.triangle[lane]), group.u[lane], group.v[lane]};
    const MirrorLaw law = evaluateMirrorLaw(mesh_->triangles()[at.triangle], at.u, at.v, eye_, point);
    sink.write(group.vertex[lane], placeUnreflected({at, law}, point).checked());
  });
  forEachLane(group.hard, [&](std::size_t lane) { solveHard(sink, group.vertex[lane]); });
}

void VirtualObjectSolver::solveHard(const VertexSink& sink, std::size_t i) const {
  const dvec3 point(sink.scenePoints[i]);
  LanePlace* place = sink.places != nullptr ? &(*sink.places)[i] : nullptr;
  std::optional<VirtualVertex> vertex;
  if (place != nullptr && place->triangle >= 0 && std::size_t(place->triangle) < laneTriangles_.size())
    vertex = solveFrom({std::uint32_t(place->triangle), place->u, place->v}, point);
  if (!vertex) {
    double nearWeight;
    const dvec2 coords = computeCoords(point, nearWeight);
    vertex = solveRefined(point, seedMap_.at(coords), nearWeight);
  }
  sink.write(i, vertex->checked());
  if (place == nullptr) return;
  const bool isFound = vertex->kind == VertexKind::Reflected || vertex->kind == VertexKind::PastBoundary;
  *place = {isFound ? std::int32_t(vertex->at.triangle) : -1, float(vertex->at.u), float(vertex->at.v)};
}

void VirtualObjectSolver::solveGroup(const VertexSink& sink, LaneGroup& group, Stragglers& stragglers) const {
  // 1
  unsigned unknown = 0;
  for (unsigned lane = 0; lane < unsigned(kLanes); ++lane)
    unknown |= unsigned(group.triangle[lane] < 0) << lane;
  unknown &= group.wanted;
  if (unknown != 0) {
    hideLanes(laneView_, group);
    forEachLane(group.hidden & unknown, [&](std::size_t lane) {
      sink.write(group.vertex[lane], laneOf(group.virtualPosition, lane), laneOf(group.position, lane),
                 VertexKind::DoublyVirtual);
    });
    group.wanted &= ~(group.hidden & unknown);
    if (group.wanted == 0) return;
  }
  // 2
  searchLanes(laneView_, group, kStragglers);
  conclude(sink, group);
  // 3
  forEachLane(group.goesOn, [&](std::size_t lane) {
    moveLane(group, lane, stragglers.group, stragglers.count++);
    if (stragglers.count == std::size_t(kLanes)) solveStragglers(sink, stragglers);
  });
}

void VirtualObjectSolver::solveStragglers(const VertexSink& sink, Stragglers& stragglers) const {
  if (stragglers.count == 0) return;
  LaneGroup& group = stragglers.group;
  group.wanted = (1u << stragglers.count) - 1;
  group.hasBegun = true;
  for (std::size_t lane = stragglers.count; lane < std::size_t(kLanes); ++lane)
    moveLane(group, 0, group, lane);
  searchLanes(laneView_, group, 0);
  conclude(sink, group);
  stragglers.count = 0;
}

void VirtualObjectSolver::computeInLanes(const VertexSink& sink, std::span<const std::uint32_t> vertices,
                                         Stragglers& stragglers) const {
  for (; !vertices.empty(); vertices = vertices.subspan(std::min(vertices.size(), std::size_t(kLanes)))) {
    LaneGroup group;
    gatherGroup(sink, vertices.first(std::min(vertices.size(), std::size_t(kLanes))), group);
    solveGroup(sink, group, stragglers);
  }
}

}  // namespace catoptric::virtual_object
