// SPDX-License-Identifier: Apache-2.0
// Refined, eight vertices side by side, for convex mirrors (virtual_object_solver.h): what a frame's time
// depends on.
//
// Vertices and searches wait until eight of their kind are there:
//   1. Not seen in the last frame: surely hidden by the mirror? Then no search. What was seen is not asked,
//      for if it is hidden now, its search finds nothing: a convex mirror lies behind the tangent plane of
//      every root.
//   2. What is not hidden is searched together (lane_search.h), until only a few of eight go on.
//   3. These go on together.
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

void setLane(LaneGroup& group, std::size_t lane, std::size_t vertex, const vec3& point,
             const LanePlace& place) {
  group.vertex[lane] = vertex;
  for (int k = 0; k < 3; ++k) group.point[k][lane] = point[k];
  group.triangle[lane] = place.triangle, group.u[lane] = place.u, group.v[lane] = place.v;
  group.lostBy[lane] = place.lostBy;
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
    forEachLane(group.found, [&](std::size_t lane) {
      (*sink.places)[group.vertex[lane]] = {group.triangle[lane], group.u[lane], group.v[lane]};
    });
  forEachLane(group.lost, [&](std::size_t lane) {
    const dvec3 point(sink.scenePoints[group.vertex[lane]]);
    const SurfacePoint at{std::uint32_t(group.triangle[lane]), group.u[lane], group.v[lane]};
    const MirrorLaw law = evaluateMirrorLaw(mesh_->triangles()[at.triangle], at.u, at.v, eye_, point);
    const VirtualVertex vertex = placeUnreflected({at, law}, point).checked();
    sink.write(group.vertex[lane], vertex);
    if (sink.places == nullptr) return;
    // Where the ray enters the mirror tells it the next time, else what the hidden map shows there.
    const bool enters = law.isStraight() && glm::dot(law.normal, law.toEye) > 0;
    const SurfacePoint& kept = enters || vertex.kind == VertexKind::None ? at : vertex.at;
    (*sink.places)[group.vertex[lane]] = {std::int32_t(kept.triangle), float(kept.u), float(kept.v),
                                          group.lostBy[lane]};
  });
  forEachLane(group.hard, [&](std::size_t lane) { solveHard(sink, group.vertex[lane]); });
}

void VirtualObjectSolver::solveHard(const VertexSink& sink, std::size_t i) const {
  const dvec3 point(sink.scenePoints[i]);
  LanePlace* place = sink.places != nullptr ? &(*sink.places)[i] : nullptr;
  std::optional<VirtualVertex> vertex;
  if (place != nullptr && place->isSeen() && std::size_t(place->triangle) < laneTriangles_.size())
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

/// Writes those that are surely hidden, and wants them no more.
void VirtualObjectSolver::hideGroup(const VertexSink& sink, LaneGroup& group) const {
  hideLanes(laneView_, group);
  forEachLane(group.hidden, [&](std::size_t lane) {
    sink.write(group.vertex[lane], laneOf(group.virtualPosition, lane), laneOf(group.position, lane),
               VertexKind::DoublyVirtual);
  });
  group.wanted &= ~group.hidden;
}

void VirtualObjectSolver::solveQueue(const VertexSink& sink, WaitingLanes::Queue& queue,
                                     WaitingLanes& waiting) const {
  if (queue.count == 0) return;
  LaneGroup& group = queue.group;
  group.wanted = (1u << queue.count) - 1;
  for (std::size_t lane = queue.count; lane < std::size_t(kLanes); ++lane) moveLane(group, 0, group, lane);
  queue.count = 0;
  const bool isLast = &queue == &waiting.stragglers;
  if (&queue == &waiting.unseen) hideGroup(sink, group);  // 1
  if (group.wanted == 0) return;
  searchLanes(laneView_, group, isLast ? 0 : kStragglers);  // 2
  conclude(sink, group);
  forEachLane(group.goesOn, [&](std::size_t lane) {  // 3
    WaitingLanes::Queue& to = waiting.stragglers;
    to.group.hasBegun = true;
    moveLane(group, lane, to.group, to.count++);
    if (to.count == std::size_t(kLanes)) solveQueue(sink, to, waiting);
  });
}

void VirtualObjectSolver::computeInLanes(const VertexSink& sink, std::span<const std::uint32_t> vertices,
                                         WaitingLanes& waiting) const {
  constexpr std::size_t kAhead = 16;  // so that their triangles are in the cache by then
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (sink.places != nullptr && i + kAhead < vertices.size())
      prefetch((*sink.places)[vertices[i + kAhead]]);
    const std::uint32_t v = vertices[i];
    const vec3& point = sink.scenePoints[v];
    if (!std::isfinite(point.x + point.y + point.z)) {
      sink.write(v, VirtualVertex{});
      continue;
    }
    const LanePlace place = sink.places != nullptr ? (*sink.places)[v] : LanePlace{};
    WaitingLanes::Queue& queue = place.isSeen() ? waiting.seen : waiting.unseen;
    setLane(queue.group, queue.count++, v, point, place);
    if (queue.count == std::size_t(kLanes)) solveQueue(sink, queue, waiting);
  }
}

/// All that still waits.
void VirtualObjectSolver::finishLanes(const VertexSink& sink, WaitingLanes& waiting) const {
  solveQueue(sink, waiting.seen, waiting);
  solveQueue(sink, waiting.unseen, waiting);
  solveQueue(sink, waiting.stragglers, waiting);
}

/// Has the triangle where a search will begin brought into the cache.
void VirtualObjectSolver::prefetch(const LanePlace& place) const {
  if (std::size_t(place.triangle) >= laneTriangles_.size()) return;
  const char* record = reinterpret_cast<const char*>(&laneTriangles_[std::size_t(place.triangle)]);
  for (std::size_t line = 0; line < sizeof(LaneTriangle); line += 64) __builtin_prefetch(record + line);
}

}  // namespace catoptric::virtual_object
