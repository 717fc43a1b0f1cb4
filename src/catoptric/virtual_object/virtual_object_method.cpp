// SPDX-License-Identifier: Apache-2.0
// Steps: 1 virtual vertices on the CPU, 2 draw the virtual object where the level before shows the mirror,
// dropping fragments before the mirror's own depth, 3 the environment in the mirror direction behind it.
#include "catoptric/virtual_object/virtual_object_method.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/make_point_finder.h"
#include "catoptric/virtual_object/mixed/mirror_samples.h"

namespace catoptric::virtual_object {

namespace {

constexpr double kMapsServeWithin = 0.2;  // searches begin a tenth of the mirror's radius off at most

/// What the parts of a mirror show is held against the scene's own triangles, pixel by pixel.
raster::TessellationOptions forParts(raster::TessellationOptions options) {
  options.levels = nullptr;
  options.coarseInPlanes = false;
  return options;
}

}  // namespace

VirtualObjectMethod::Prepared::Prepared(const scene::WorldGeometry& world, std::uint32_t reflector,
                                        bool flipped, const raster::TessellationOptions& options,
                                        bool mayBeInParts)
    : maxErrorPx(options.maxErrorPx),
      sizePx(options.reflectorDiameterPx),
      isFromBehind(flipped),
      mesh(world, reflector, ReflectorMeshOptions{.flipped = flipped}),
      tessellation(world, reflector, mayBeInParts && !mesh.isConvex() ? forParts(options) : options),
      objects(tessellation.objects()),
      runs(objects),
      triangleRuns(objects.positions, objects.indices),
      pass(objects),
      virtualPositions(objects.positions.size()),
      reflectionPoints(objects.positions.size()),
      kinds(objects.positions.size()) {}

void VirtualObjectMethod::Prepared::update(const scene::WorldGeometry& world) {
  if (movedParts.empty()) return;
  std::sort(movedParts.begin(), movedParts.end());
  movedParts.erase(std::unique(movedParts.begin(), movedParts.end()), movedParts.end());
  tessellation.update(world, movedParts);
  movedParts.clear();
  runs = VertexRuns(objects);
  triangleRuns = TriangleRuns(objects.positions, objects.indices);
  pass.objectsChanged();
  numbered.reset();
  gpu.reset();
  if (inParts) inParts->judged.reset();
  virtualPositions.resize(objects.positions.size());
  reflectionPoints.resize(objects.positions.size());
  kinds.resize(objects.positions.size());
  isFoundOnCpu = false;
}

void VirtualObjectMethod::partsMoved(const scene::WorldGeometry& world,
                                     std::span<const std::uint32_t> parts) {
  last_.clear();
  uncut_.reset();
  std::erase_if(prepared_, [&](const auto& entry) {
    const std::uint32_t own = world.reflectors[std::get<0>(entry.first)].part;
    return std::find(parts.begin(), parts.end(), own) != parts.end();
  });
  for (auto& [key, prepared] : prepared_)
    prepared->movedParts.insert(prepared->movedParts.end(), parts.begin(), parts.end());
}

/// Filling the maps of one mirror keeps one core busy; those of several are filled beside each other.
void VirtualObjectMethod::prepare(raster::FrameContext& frame) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Prepared*> shown;
  for (const auto& [reflector, prepared] : last_)
    if (prepared->solver && prepared->solver->eye() != frame.camera.eye) shown.push_back(prepared);
  core::parallelFor(shown.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      shown[i]->setEye(shown[i]->mesh, frame.scene.geometry().bounds, frame.camera.eye, solverOptions());
  });
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  frame.counters.virtualVerticesMs += spent.count();
  last_.clear();
}

/// Those whose sag is about twice the error that is allowed, where the mirror covers the pixels that it was
/// prepared for.
raster::LongestChords VirtualObjectMethod::findLongestChords(const Prepared& p) {
  const auto chordOf = [&](double sagPx) {
    return float(p.mesh.bodyRadius() * std::sqrt(16.0 * sagPx / p.sizePx));
  };
  const bool hasBoundary = p.mesh.ordinaryCount() != p.mesh.triangles().size();
  return {hasBoundary ? std::numeric_limits<float>::infinity() : chordOf(std::max(2.0 * p.maxErrorPx, 1.0)),
          chordOf(2.0 * p.maxErrorPx + 1.0)};
}

VirtualObjectMethod::InParts::InParts(const ReflectorMesh& mesh) : InParts(mesh, cutIntoParts(mesh)) {}

VirtualObjectMethod::InParts::InParts(const ReflectorMesh& mesh, CutMirror cut) : buffers(mesh, cut) {
  for (MirrorPart& shape : cut.parts) parts.emplace_back().shape = std::move(shape);
}

VirtualObjectMethod::Prepared& VirtualObjectMethod::prepareReflector(const raster::FrameContext& frame,
                                                                     const raster::Chain& chain,
                                                                     const dvec3& drawEye) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const scene::Reflector& reflector = world.reflectors[*chain.curved];
  const bool flipped = isSeenFromBehind(world, *chain.curved, drawEye);
  const double size = raster::findTessellationSize(reflector, drawEye, frame.camera);
  const bool isMirrored = chain.drawFromWorld != dmat4(1.0);
  const Drawing drawing = findDrawing(chain, world);
  std::unique_ptr<Prepared>& slot = prepared_[{*chain.curved, flipped, isMirrored, drawing, size}];
  if (slot && slot->maxErrorPx == frame.maxErrorPx) {
    slot->update(world);
    return *slot;
  }
  raster::TessellationOptions options{
      .maxErrorPx = frame.maxErrorPx, .reflectorDiameterPx = size, .keepsBehind = isMirrored};
  if (drawing != Drawing::AsPublished) {
    options.isSeenDirectly = !isMirrored;
    options.levels = &frame.scene.levels();
  }
  std::vector<std::uint8_t> isPlain;
  for (std::uint32_t part = 0; part < world.parts.size(); ++part)
    isPlain.push_back((findCoverFlags(frame.scene, part) & (kCoverMasked | kCoverBlended)) == 0 ? 1 : 0);
  if (drawing == Drawing::Numbered) options.shadedByRays = isPlain, options.coarseInPlanes = true;
  slot = std::make_unique<Prepared>(world, *chain.curved, flipped, options, solver_ == Solver::Refined);
  for (const std::uint8_t isNumbered : isPlain) slot->isDrawn.push_back(isNumbered ? 0 : 1);
  slot->isNumbered = std::move(isPlain);
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

void VirtualObjectMethod::Search::setEye(const ReflectorMesh& mesh, const core::Box& sceneBounds,
                                         const dvec3& eye, const SolverOptions& options) {
  const double reach = glm::length(sceneBounds.centre() - mesh.centre()) + sceneBounds.radius();
  if (!solver || farRadius != reach) {
    farRadius = reach;
    finderOf = Solver::Refined;
    solver = std::make_unique<VirtualObjectSolver>(mesh, eye, farRadius, options);
  } else if (solver->eye() != eye) {
    solver->setEye(eye);
  }
}

SolverOptions VirtualObjectMethod::solverOptions() const {
  SolverOptions options;
  // Refined only begins where its maps say, and a new eye pays for each of their pixels.
  if (solver_ == Solver::Refined) {
    options.mapResolution /= 2, options.seedResolution /= 2, options.hiddenMapResolution /= 2;
    options.mapsServeWithin = kMapsServeWithin;
  }
  return options;
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
    prepared.runs.findReflected(prepared.solver->reflectedBeams(), chain.drawFromWorld, prepared.mayReflect);
  if (!wanted.empty()) {
    prepared.mayReflect.resize(wanted.size(), VertexBits(~0u));
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] == 0) prepared.mayReflect[i] = 0;
  }
  prepared.solver->compute(solver, points, prepared.virtualPositions, prepared.kinds,
                           prepared.reflectionPoints, prepared.mayReflect, &prepared.places);
  const std::size_t culled = prepared.runs.countLeftOut(prepared.mayReflect);
  frame.counters.virtualVertices += points.size() - culled;
  if (wanted.empty()) frame.counters.culledVertices += culled;
  prepared.isFoundOnCpu = wanted.empty();
}

dvec3 VirtualObjectMethod::findDrawEye(const raster::FrameContext& frame, const raster::Chain& chain) {
  return dvec3(glm::inverse(chain.screenFromDraw) * dvec4(frame.camera.eye, 1.0));
}

void VirtualObjectMethod::noteShown(const raster::Chain& chain, Prepared& p, const dvec3& drawEye) {
  p.eye = drawEye;
  if (chain.level == 1) last_[chain.last] = &p;
}

bool VirtualObjectMethod::findVertices(raster::FrameContext& frame, const raster::Chain& chain,
                                       Prepared& p) const {
  const auto start = std::chrono::steady_clock::now();
  p.setEye(p.mesh, frame.scene.geometry().bounds, p.eye, solverOptions());
  if (!p.solver->canReflect()) return false;
  if (!usesGpu(p)) {
    computeVirtualVertices(frame, chain, p);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    frame.counters.virtualVerticesMs += spent.count();
  }
  frame.counters.simplifiedTriangles += p.objects.simplifiedTriangles;
  return true;
}

bool VirtualObjectMethod::drawObjects(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::Level& parent, raster::Level& target) {
  // 1
  const dvec3 drawEye = findDrawEye(frame, chain);
  if (!chain.curved)
    return drawNumbered(frame, beginMirror(0, frame, chain, makeView(frame, chain, drawEye, parent), nullptr),
                        target);
  Prepared& p = prepareReflector(frame, chain, drawEye);
  if (p.objects.indices.empty()) return false;
  const raster::SurfaceView view = makeView(frame, chain, drawEye, parent);
  noteShown(chain, p, drawEye);
  if (isInParts(p, frame.scene.geometry())) {
    p.isFoundOnCpu = false;
    if (canUseNumbers(chain, frame.scene.geometry()) && !hasCutOuts(frame.scene))
      drawInParts(frame, chain, view, parent, target, p);
    else
      exact_.render(frame, chain, parent, target);
    return true;
  }
  if (!findVertices(frame, chain, p)) return false;

  // 2
  if (usesGpu(p)) {
    drawOnGpu(frame, chain, view, p, target);
    return false;
  }
  if (findDrawing(chain, frame.scene.geometry()) == Drawing::Numbered)
    return drawNumbered(frame, beginMirror(0, frame, chain, view, &p), target);
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
  if (chain.curved && chain.last != *chain.curved)
    raster::clipAtLastMirror(reflectors[chain.last], chain.last, reflectors[*chain.curved].centre, view);
  return view;
}

void VirtualObjectMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                 const raster::Level& parent, raster::Level& target) {
  rects_.rest.clear();
  const bool isComplete = drawObjects(frame, chain, parent, target);
  // 3
  if (!isComplete) background_.draw(frame.scene, chain, parent, target, true, rects_.rest);
}

}  // namespace catoptric::virtual_object
