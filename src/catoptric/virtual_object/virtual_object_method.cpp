// SPDX-License-Identifier: Apache-2.0
// Steps: 1 virtual vertices on the CPU, 2 draw the virtual object where the level before shows the mirror,
// dropping fragments before the mirror's own depth, 3 the environment in the mirror direction behind it.
#include "catoptric/virtual_object/virtual_object_method.h"

#include <chrono>

#include "catoptric/virtual_object/make_point_finder.h"

namespace catoptric::virtual_object {

VirtualObjectMethod::Prepared::Prepared(const scene::WorldGeometry& world, std::uint32_t reflector,
                                        bool flipped, const raster::TessellationOptions& tessellation)
    : maxErrorPx(tessellation.maxErrorPx),
      isFromBehind(flipped),
      mesh(world, reflector, ReflectorMeshOptions{.flipped = flipped}),
      objects(raster::tessellateForReflector(world, reflector, tessellation)),
      runs(objects, VirtualObjectSolver::kRunLength),
      pass(objects),
      virtualPositions(objects.positions.size()),
      reflectionPoints(objects.positions.size()),
      kinds(objects.positions.size()) {}

VirtualObjectMethod::InParts::InParts(const ReflectorMesh& mesh) : InParts(mesh, cutIntoParts(mesh)) {}

VirtualObjectMethod::InParts::InParts(const ReflectorMesh& mesh, CutMirror cut) : buffers(mesh, cut) {
  for (MirrorPart& part : cut.parts) parts.push_back({std::move(part), nullptr});
}

VirtualObjectMethod::Prepared& VirtualObjectMethod::prepareReflector(const raster::FrameContext& frame,
                                                                     const raster::Chain& chain,
                                                                     const dvec3& drawEye) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const scene::Reflector& reflector = world.reflectors[*chain.curved];
  bool flipped = false;
  if (reflector.doubleSided) {  // which side does the eye see? the one most triangles turn to it
    const scene::Part& part = world.parts[reflector.part];
    double facing = 0;
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i) {
      const std::uint32_t v = world.indices[i];
      const dvec3 toEye = drawEye - dvec3(world.positions[v]);
      facing += glm::dot(dvec3(world.normals[v]), toEye) > 0.0 ? 1.0 : -1.0;
    }
    flipped = facing < 0;
  }
  const double size = raster::findTessellationSize(reflector, drawEye, frame.camera);
  const bool isMirrored = chain.drawFromWorld != dmat4(1.0);
  const bool isSeenDirectly = !isMirrored && solver_ != Solver::Explosion;
  std::unique_ptr<Prepared>& slot = prepared_[{*chain.curved, flipped, isMirrored, isSeenDirectly, size}];
  if (!slot || slot->maxErrorPx != frame.maxErrorPx)
    slot = std::make_unique<Prepared>(world, *chain.curved, flipped,
                                      raster::TessellationOptions{.maxErrorPx = frame.maxErrorPx,
                                                                  .reflectorDiameterPx = size,
                                                                  .isSeenDirectly = isSeenDirectly,
                                                                  .keepsBehind = isMirrored});
  return *slot;
}

Solver VirtualObjectMethod::equipSolver(const scene::WorldGeometry& world, std::uint32_t reflector,
                                        Prepared& prepared) const {
  if (solver_ == Solver::Explosion || solver_ == Solver::Refined) return solver_;
  if (prepared.finderOf != solver_) {
    prepared.finderOf = solver_;
    prepared.solver->useFinder(
        makePointFinder(solver_, world, reflector, prepared.isFromBehind, prepared.mesh));
  }
  return prepared.solver->hasFinder() ? solver_ : Solver::Refined;
}

void VirtualObjectMethod::prepareSolver(const scene::WorldGeometry& world, const dvec3& drawEye,
                                        Prepared& prepared) {
  if (!prepared.solver) {
    const core::Box& bounds = world.bounds;
    const double farRadius = glm::length(bounds.centre() - prepared.mesh.centre()) + bounds.radius();
    prepared.solver = std::make_unique<VirtualObjectSolver>(prepared.mesh, drawEye, farRadius);
  } else if (prepared.solver->eye() != drawEye) {
    prepared.solver->setEye(drawEye);
  }
}

void VirtualObjectMethod::computeVirtualVertices(raster::FrameContext& frame, const raster::Chain& chain,
                                                 Prepared& prepared,
                                                 std::span<const std::uint8_t> wanted) const {
  std::span<const vec3> points = prepared.objects.positions;
  if (chain.drawFromWorld != dmat4(1.0)) {
    prepared.scenePoints.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      prepared.scenePoints[i] = vec3(dvec3(chain.drawFromWorld * dvec4(dvec3(points[i]), 1.0)));
    points = prepared.scenePoints;
  }
  const Solver solver = equipSolver(frame.scene.geometry(), *chain.curved, prepared);
  prepared.mayReflect.clear();
  if (solver != Solver::Explosion && prepared.solver->canReflect())  // the method as published has no culling
    findReflectedRuns(prepared.runs, prepared.solver->reflectedCone(), chain.drawFromWorld,
                      prepared.mayReflect);
  if (!wanted.empty()) {
    prepared.mayReflect.resize(wanted.size(), 1);
    for (std::size_t i = 0; i < wanted.size(); ++i) prepared.mayReflect[i] &= wanted[i];
  }
  prepared.solver->compute(solver, points, prepared.virtualPositions, prepared.kinds,
                           prepared.reflectionPoints, prepared.mayReflect);
  const std::size_t culled = prepared.runs.countLeftOut(prepared.mayReflect);
  frame.counters.virtualVertices += points.size() - culled;
  if (wanted.empty()) frame.counters.culledVertices += culled;
  prepared.isFoundOnCpu = wanted.empty();
}

bool VirtualObjectMethod::drawObjects(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::Level& parent, raster::Level& target) {
  // 1
  const dvec3 drawEye = dvec3(glm::inverse(chain.screenFromDraw) * dvec4(frame.camera.eye, 1.0));
  Prepared& p = prepareReflector(frame, chain, drawEye);
  if (p.objects.indices.empty()) return false;
  const raster::SurfaceView view = makeView(frame, chain, drawEye, parent);
  p.eye = drawEye;
  if (chain.level == 1) last_[chain.last] = &p;
  if (isInParts(p, frame.scene.geometry())) {
    p.isFoundOnCpu = false;
    if (usesNumbers(chain, frame.scene.geometry()) && !hasCutOuts(frame.scene))
      drawInParts(frame, chain, view, parent, target, p);
    else
      exact_.render(frame, chain, parent, target);
    return true;
  }
  const auto start = std::chrono::steady_clock::now();
  prepareSolver(frame.scene.geometry(), drawEye, p);
  if (!p.solver->canReflect()) return false;
  const bool onGpu = usesGpu(p);
  if (!onGpu) {
    computeVirtualVertices(frame, chain, p);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    frame.counters.virtualVerticesMs += spent.count();
  }

  // 2
  if (onGpu) {
    drawOnGpu(frame, chain, view, p, target);
    return false;
  }
  if (usesNumbers(chain, frame.scene.geometry())) {
    drawNumbered(frame, chain, view, p, target);
    return false;
  }
  const bool isMirrored = chain.drawFromWorld != dmat4(1.0);
  p.pass.draw(frame, view, p.virtualPositions, p.kinds, p.reflectionPoints,
              isMirrored ? std::span<const vec3>(p.scenePoints) : std::span<const vec3>(), target);
  return false;
}

raster::SurfaceView VirtualObjectMethod::makeView(const raster::FrameContext& frame,
                                                  const raster::Chain& chain, const dvec3& drawEye,
                                                  const raster::Level& parent) {
  raster::SurfaceView view;
  view.clipFromDraw =
      raster::makeClipFromWorld(frame.camera, frame.nearPlane, frame.jitterPx) * chain.screenFromDraw;
  view.eye = view.drawEye = drawEye;
  view.windingFlipped = chain.level % 2 == 1;
  view.chain = &chain;
  view.parent = &parent;
  view.masking = frame.masking;
  const auto& reflectors = frame.scene.geometry().reflectors;
  if (chain.last != *chain.curved)
    raster::clipAtLastMirror(reflectors[chain.last], chain.last, reflectors[*chain.curved].centre, view);
  return view;
}

void VirtualObjectMethod::prepareNumbers(const raster::FrameContext& frame, Prepared& p) {
  if (p.numbered) return;
  p.numbered = std::make_unique<NumberedTriangles>(p.objects);
  for (std::uint32_t part = 0; part < frame.scene.geometry().parts.size(); ++part) {
    const bool isPlain = (findCoverFlags(frame.scene, part) & (kCoverMasked | kCoverBlended)) == 0;
    p.isNumbered.push_back(isPlain ? 1 : 0);
    p.isDrawn.push_back(isPlain ? 0 : 1);
  }
}

void VirtualObjectMethod::drawNumbered(raster::FrameContext& frame, const raster::Chain& chain,
                                       const raster::SurfaceView& view, Prepared& p, raster::Level& target) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  prepareNumbers(frame, p);
  raster::markVirtualTriangles(p.objects, view.drawEye, p.virtualPositions, p.kinds, p.reflectionPoints,
                               triangles_);
  const PictureView picture{mat4(view.clipFromDraw), view.parent->widthPx, view.parent->heightPx,
                            view.windingFlipped};
  frame.counters.culledTriangles += dropUnseenTriangles(p.objects, world, picture, chain.bounds,
                                                        p.virtualPositions, screen_, triangles_.isKept);
  raster::gatherVirtualTriangles(p.objects, p.numbered->indices(), p.isNumbered, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  ranges_.clear();
  for (const raster::TessellatedPart& part : triangles_.parts)
    if (part.indexCount > 0) ranges_.push_back({part.part, part.firstIndex, part.indexCount});

  shading_.prepare(frame.scene, *view.parent);
  shading_.beginHits(chain.bounds);
  p.numbered->draw(frame, view, numberProgram_, p.virtualPositions, triangles_.indices, ranges_);
  shading_.readHits(chain.bounds, hits_);
  findPartRects(world, chain.bounds, hits_, frame.parentIds, view.parent->widthPx, chain.parentWord(),
                rects_);
  shading_.shadeVirtual(frame, chain, *view.parent, target, false, rects_.inner);
  shading_.shadeVirtual(frame, chain, *view.parent, target, true, rects_.edges);

  raster::gatherVirtualTriangles(p.objects, p.objects.indices, p.isDrawn, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  if (!triangles_.indices.empty()) p.pass.drawSelected(frame, view, p.virtualPositions, triangles_, target);
}

void VirtualObjectMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                 const raster::Level& parent, raster::Level& target) {
  const bool isComplete = drawObjects(frame, chain, parent, target);
  // 3
  if (!isComplete) background_.draw(frame.scene, chain, parent, target);
}

}  // namespace catoptric::virtual_object
