// SPDX-License-Identifier: Apache-2.0
// The virtual object of a mirror as an eye elsewhere sees it (1998, fig. 10 and 11): what the last frame has
// computed, drawn again; nothing is computed anew but the reflection point of one scene point.
//
// Steps: 1 the virtual object (of a mirror that is not convex, those of its parts and intervals), shaded as
// in the mirror, without the shell of the room, which would hide it; 2 edges of the tessellation, as it
// stands and as it is drawn; 3 the mirror's triangles and the rays that leave its corners: the edges of the
// reflected cells; 4 for one point its way to the eye, where it is drawn, and the cell that it lies in.
#include <algorithm>
#include <array>

#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kMostRays = 80, kMostMeshTriangles = 250, kMostEdges = 400000;
const vec3 kRealColor(0.25f, 0.3f, 0.35f), kVirtualColor(0.9f, 0.45f, 0.1f), kMeshColor(0.35f, 0.45f, 0.6f),
    kRayColor(0.5f, 0.7f, 0.2f), kCellColor(1.0f, 0.1f, 0.6f), kPathColor(1.0f, 0.9f, 0.1f);

}  // namespace

void VirtualObjectMethod::completeOnCpu(const scene::WorldGeometry& world, std::uint32_t reflector,
                                        Prepared& p) const {
  if (p.isFoundOnCpu) return;
  p.setEye(p.mesh, world.bounds, p.eye, solverOptions());
  const Solver solver = equipSolver(world, reflector, p);
  p.solver->compute(solver, p.objects.positions, p.virtualPositions, p.kinds, p.reflectionPoints);
  p.isFoundOnCpu = true;
}

void VirtualObjectMethod::drawFromElsewhere(raster::FrameContext& frame, std::uint32_t reflector,
                                            const raster::SurfaceView& elsewhere, raster::Level& target) {
  const auto last = last_.find(reflector);
  if (last == last_.end()) return;
  Prepared& p = *last->second;
  // 1
  const scene::WorldGeometry& world = frame.scene.geometry();
  std::vector<std::uint8_t> isWanted(world.parts.size());
  for (std::size_t i = 0; i < isWanted.size(); ++i) isWanted[i] = world.parts[i].shell ? 0 : 1;
  raster::Chain chain;
  chain.last = reflector;
  chain.bounds = {0, 0, target.widthPx, target.heightPx};
  raster::SurfaceView view = elsewhere;
  view.windingFlipped = true;  // images in a mirror are turned round, from wherever they are looked at
  view.chain = &chain;
  const auto draw = [&](std::span<const vec3> positions) {
    raster::gatherVirtualTriangles(p.objects, p.objects.indices, isWanted, triangles_);
    p.pass.drawSelected(frame, view, positions, triangles_, target);
  };
  if (p.inParts && std::any_of(p.inParts->parts.begin(), p.inParts->parts.end(),
                               [](const InParts::Part& part) { return part.isAnyWorthIt(); })) {
    drawPartsFromElsewhere(frame, p, view, draw);
    return;
  }
  completeOnCpu(world, reflector, p);
  raster::markVirtualTriangles(p.objects, p.solver->eye(), p.virtualPositions, p.kinds, p.reflectionPoints,
                               triangles_);
  draw(p.virtualPositions);
}

/// Step 1 in a mirror drawn in parts: a virtual object for each interval. Past one focus it stands reversed.
void VirtualObjectMethod::drawPartsFromElsewhere(raster::FrameContext& frame, Prepared& p,
                                                 raster::SurfaceView& view,
                                                 const std::function<void(std::span<const vec3>)>& draw) {
  for (InParts::Part& part : p.inParts->parts) {
    if (!part.isAnyWorthIt() || !findPartVertices(frame, p.eye, part, p)) continue;
    for (std::size_t i = 0; i < kIntervals; ++i) {
      if (!part.isWorthIt[i]) continue;
      view.windingFlipped = i != 1;
      const bool isConvex = part.shape.bend == Bend::Convex;
      if (isConvex)
        raster::markVirtualTriangles(p.objects, p.eye, p.virtualPositions, p.kinds, p.reflectionPoints,
                                     triangles_);
      else
        markIntervalTriangles(p.objects, part.found[i], triangles_.isKept);
      draw(isConvex ? p.virtualPositions : part.found[i].positions);
    }
  }
}

void VirtualObjectMethod::collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                                       const raster::MarkOptions& options, raster::Marks& marks) const {
  const auto last = last_.find(reflector);
  if (last == last_.end()) return;
  completeOnCpu(world, reflector, *last->second);
  const Prepared& p = *last->second;
  if (options.tessellation) addTessellation(world, p, marks);
  if (options.cells) addCells(p, 2.0 * world.bounds.radius(), marks);
  if (options.point) addPath(p, *options.point, marks);
}

void VirtualObjectMethod::addTessellation(const scene::WorldGeometry& world, const Prepared& p,
                                          raster::Marks& marks) {
  // 2. Each inner edge belongs to two triangles: it is drawn by the one in which it goes upwards.
  const auto& indices = p.objects.indices;
  for (const raster::TessellatedPart& part : p.objects.parts) {
    if (world.parts[part.part].shell) continue;
    for (std::size_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i) {
      const std::uint32_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
      if (a > b || marks.linePositions.size() > 2 * kMostEdges) continue;
      marks.addLine(p.objects.positions[a], p.objects.positions[b], kRealColor);
      if (p.kinds[a] == VertexKind::Reflected && p.kinds[b] == VertexKind::Reflected)
        marks.addLine(p.virtualPositions[a], p.virtualPositions[b], kVirtualColor);
    }
  }
}

void VirtualObjectMethod::addCells(const Prepared& p, double rayLength, raster::Marks& marks) {
  // 3
  const auto positions = p.mesh.positions();
  const auto corners = p.mesh.corners();
  const ReflectedRays& rays = p.solver->reflectedRays();
  std::vector<std::uint8_t> isBody(positions.size(), 0);
  // Of a fine mesh some triangles only: one sees through to what is behind them.
  const std::size_t every = p.mesh.ordinaryCount() / kMostMeshTriangles + 1;
  for (std::size_t t = 0; t < p.mesh.ordinaryCount(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[3 * t + k], b = corners[3 * t + (k + 1) % 3];
      isBody[a] = 1;
      if (t % every == 0) marks.addLine(positions[a], positions[b], kMeshColor);
    }
  const std::size_t step = std::max<std::size_t>(1, positions.size() / kMostRays);
  for (std::size_t v = 0; v < std::min(positions.size(), rays.directions.size()); v += step)
    if (isBody[v] && rays.isFront[v])
      marks.addLine(positions[v], positions[v] + rayLength * rays.directions[v], kRayColor);
}

void VirtualObjectMethod::addPath(const Prepared& p, const dvec3& point, raster::Marks& marks) {
  // 4
  const auto found = p.solver->findReflectionPoint(Solver::Refined, point);
  if (!found || found->kind != VertexKind::Reflected) return;
  marks.addLine(p.solver->eye(), found->position, kPathColor);
  marks.addLine(found->position, point, kPathColor);
  marks.addLine(found->position, found->virtualPosition, kVirtualColor);
  const double length = 1.5 * glm::length(point - found->position);
  const ReflectedRays& rays = p.solver->reflectedRays();
  std::array<dvec3, 3> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = p.mesh.corners()[3 * std::size_t(found->at.triangle) + k];
    ends[k] = p.mesh.positions()[v] + length * rays.directions[v];
    marks.addLine(p.mesh.positions()[v], ends[k], kCellColor);
  }
  for (std::size_t k = 0; k < 3; ++k) marks.addLine(ends[k], ends[(k + 1) % 3], kCellColor);
}

}  // namespace catoptric::virtual_object
