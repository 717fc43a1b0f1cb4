// SPDX-License-Identifier: Apache-2.0
// Virtual vertices by explosion maps (Ofek & Rappoport 1998, fig. 7) and by a Newton search that starts from
// them.
//
// Explosion:
//   1. Hidden? Look Q up in the hidden map; if the triangle V there hides it, mirror Q in the plane that V
//      has where the ray E -> Q meets it. Such a vertex comes to lie outside the mirror's image, or in front
//      of its surface.
//   2. MapCoords of the direction centre -> Q, the same for both maps.
//   3. In each map: triangle, barycentrics in its mapped 2-D triangle, plane there, mirror Q in it. In an
//      extension polygon: the point of the triangle's outer edge on the same radius.
//   4. Blend with weights 1/d_near, 1/d_far of *relative* distances, that is, linearly in 1/|Q - C|.
// Refined:
//   1. The two reflection points of steps 2 and 3; walk from the heavier one over the mesh towards their
//      blend.
//   2. Newton on the mirror law across triangle edges (reflection_point.h).
//   3. Q' on the ray E -> J at |EJ| + |JQ|. J in the skirt: doubly virtual.
//   4. No root: hidden, as in Explosion step 1; it meets the reflected ones smoothly both at the line where
//      an object touches the mirror and at the rim (README).
//   On a convex mirror many vertices go through these steps side by side (refined_in_lanes.cpp).
//
// Failures and cost: see README.
#include "catoptric/virtual_object/virtual_object_solver.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/reflection_point.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kNearSphere = 1.02;       // of the mesh's radius: slightly enlarged
constexpr double kOnSurface = 1e-7;        // of the mesh's radius: a point this near lies on the mirror
constexpr double kNearlySine = 0.05;       // a root this near is good enough to place a doubly virtual vertex
constexpr double kOutsideTriangle = 1e-6;  // barycentric slack
constexpr int kFewSteps = 4;               // where the vertex was seen before is near, or no use

bool isFinite(const dvec3& p) {
  return std::isfinite(p.x + p.y + p.z);
}

std::uint32_t heavierTriangle(const SeedPixel& seed, double nearWeight) {
  return nearWeight >= 0.5 ? seed.nearTriangle : seed.farTriangle;
}

}  // namespace

VirtualObjectSolver::VirtualObjectSolver(const ReflectorMesh& mesh, const dvec3& eye, double farRadius,
                                         const SolverOptions& options)
    : mesh_(&mesh), farRadius_(farRadius), options_(options), patches_(mesh) {
  if (mesh.isConvex()) laneTriangles_ = makeLaneTriangles(mesh);
  for (ExplosionMap* map : {&nearMap_, &farMap_})
    map->ids = core::Image<std::uint32_t>(options.mapResolution, options.mapResolution, core::kNoId);
  const int hidden = options.hiddenMapResolution;
  hiddenMap_.ids = core::Image<std::uint32_t>(hidden, hidden, core::kNoId);
  hiddenMap_.distances = core::Image<float>(hidden, hidden, 0.f);
  seedMap_.pixels = core::Image<SeedPixel>(options.seedResolution, options.seedResolution);
  setEye(eye);
}

void VirtualObjectSolver::setEye(const dvec3& eye) {
  eye_ = eye;
  canReflect_ = false;
  if (mesh_->triangles().empty() || !isFinite(eye)) return;
  canReflect_ = computeReflectedRays(*mesh_, eye, rays_) > 0;
  if (!canReflect_) return;
  const double nearRadius = kNearSphere * mesh_->radius();
  const double farRadius = std::max(farRadius_, 2.0 * nearRadius);
  // Weights from relative distances d_near = (rho - r_n) / r_n, d_far = (r_f - rho) / r_f: linear in 1 / rho.
  inverseNear_ = 1.0 / nearRadius;
  layersPerInverse_ = 1.0 / (1.0 / farRadius - inverseNear_);
  const bool doServe = doMapsServe(eye);
  core::parallelFor(doServe ? 2 : 4, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i == 0) fillHiddenMap(*mesh_, eye, scratch_[0], hiddenMap_);
      if (i == 1) patches_.makeBeams(*mesh_, rays_, beams_);
      if (i == 2) fillExplosionMap(*mesh_, eye, nearRadius, rays_, scratch_[1], nearMap_);
      if (i == 3) fillExplosionMap(*mesh_, eye, farRadius, rays_, scratch_[2], farMap_);
    }
  });
  if (!doServe) {
    fillSeedMap(*mesh_, nearMap_, farMap_, seedMap_);
    mapEye_ = eye;
  }
  if (mesh_->isConvex()) prepareLanes();
  if (finder_) finder_->setEye(eyeView());
}

/// Do near and far map still say where searches may begin?
bool VirtualObjectSolver::doMapsServe(const dvec3& eye) const {
  if (!mapEye_ || !mesh_->isConvex()) return false;
  const double distance = glm::length(*mapEye_ - mesh_->centre()) - mesh_->radius();
  return glm::length(eye - *mapEye_) < options_.mapsServeWithin * distance;
}

/// Where the ray to the point meets the triangle that hides the point from the eye; nothing if none does.
/// `surely`: only where the hidden map's resolution leaves no doubt.
std::optional<SurfacePoint> VirtualObjectSolver::findHidingPoint(const dvec3& scenePoint, bool surely) const {
  const dvec3 toPoint = scenePoint - eye_;
  const double along = glm::dot(toPoint, hiddenMap_.frame.z), squared = glm::dot(toPoint, toPoint);
  if (!(along > hiddenMap_.nearest)) return std::nullopt;                       // in front of it
  if (along * along < hiddenMap_.squaredCosine * squared) return std::nullopt;  // beside it
  const dvec2 coords = computeMapCoords(hiddenMap_.frame, toPoint / std::sqrt(squared));
  const dvec2 px = (coords - hiddenMap_.lower) * hiddenMap_.pixelsPerUnit;
  const int n = hiddenMap_.ids.width();
  if (!(px.x >= 0 && px.y >= 0 && px.x <= n && px.y <= n)) return std::nullopt;
  const int x = std::min(int(px.x), n - 1), y = std::min(int(px.y), n - 1);
  std::uint32_t id = hiddenMap_.ids.at(x, y);
  bool isInside = id != core::kNoId;
  for (int k = 0; k < 9; ++k) {  // at the outline a pixel is covered in part only
    const int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
    const std::uint32_t near =
        nx < 0 || ny < 0 || nx >= n || ny >= n ? core::kNoId : hiddenMap_.ids.at(nx, ny);
    isInside = isInside && near != core::kNoId;
    if (id == core::kNoId) id = near;
  }
  if (id == core::kNoId || (surely && !isInside)) return std::nullopt;
  const MirrorTriangle& t = mesh_->triangles()[id];
  const dvec3 facet = glm::cross(t.edge1, t.edge2);
  const double fraction = glm::dot(facet, t.position0 - eye_) / glm::dot(facet, toPoint);
  if (!(fraction > 0.0 && fraction < 1.0)) return std::nullopt;
  const dvec2 uv = t.project(eye_ + fraction * toPoint);
  return clampToTriangle(id, uv.x, uv.y);
}

/// Step 1 of Explosion, step 4 of Refined.
VirtualVertex VirtualObjectSolver::mirrorHidden(const SurfacePoint& at, const dvec3& scenePoint) const {
  const MirrorTriangle& t = mesh_->triangles()[at.triangle];
  const dvec3 position = t.position(at.u, at.v);
  const dvec3 virtualPosition =
      formulas::mirrorHiddenPoint(eye_, position, glm::normalize(t.normal(at.u, at.v)), scenePoint);
  return {virtualPosition, position, at, 0, VertexKind::DoublyVirtual};
}

VirtualVertex VirtualObjectSolver::solveExplosion(const dvec3& scenePoint, const dvec2& coords,
                                                  double w) const {
  if (const auto hiding = findHidingPoint(scenePoint, false)) return mirrorHidden(*hiding, scenePoint);
  const MapAnswer nearAnswer = lookUpMap(*mesh_, nearMap_, coords),
                  farAnswer = lookUpMap(*mesh_, farMap_, coords);
  const auto mirror = [&](const SurfacePoint& at) {
    const MirrorTriangle& t = mesh_->triangles()[at.triangle];
    return formulas::mirrorInPlane(scenePoint, t.position(at.u, at.v), t.normal(at.u, at.v));
  };
  const MapAnswer& heavier = w >= 0.5 ? nearAnswer : farAnswer;
  return {w * mirror(nearAnswer.at) + (1.0 - w) * mirror(farAnswer.at),
          mesh_->triangles()[heavier.at.triangle].position(heavier.at.u, heavier.at.v), heavier.at, 0,
          heavier.isExtension ? VertexKind::DoublyVirtual : VertexKind::Reflected};
}

/// MapCoords of the direction centre -> Q, and the near map's weight.
dvec2 VirtualObjectSolver::computeCoords(const dvec3& scenePoint, double& nearWeight) const {
  const dvec3 d = scenePoint - nearMap_.centre;
  const double distance = std::sqrt(std::max(glm::dot(d, d), 1e-300));
  nearWeight = 1.0 - formulas::mapLayerOf(distance, inverseNear_, layersPerInverse_, 1.0);
  return computeMapCoords(nearMap_.frame, d * (1.0 / distance));
}

/// Step 1 of Refined, after the map was read.
SurfacePoint VirtualObjectSolver::findSeed(const SeedPixel& seed, double nearWeight) const {
  const dvec3 blend = nearWeight * dvec3(seed.nearPosition) + (1.0 - nearWeight) * dvec3(seed.farPosition);
  SurfacePoint at{heavierTriangle(seed, nearWeight)};
  const dvec2 target = mesh_->triangles()[at.triangle].project(blend);
  walkOnMesh(mesh_->triangles(), at, target.x - at.u, target.y - at.v);
  return clampToTriangle(at.triangle, at.u, at.v);  // past the mesh's end searches go astray
}

bool VirtualObjectSolver::isPastBoundary(const SurfacePoint& at) const {
  return mesh_->triangles()[at.triangle].isSkirt() ||
         std::min({at.u, at.v, 1.0 - at.u - at.v}) < -kOutsideTriangle;
}

VirtualVertex VirtualObjectSolver::placeSearched(const SearchResult& found) const {
  const MirrorLaw& law = found.law;
  return {eye_ - law.toEye * (law.distanceEye + law.distancePoint), law.position, found.at, found.steps,
          isPastBoundary(found.at) ? VertexKind::PastBoundary : VertexKind::Reflected};
}

std::optional<VirtualVertex> VirtualObjectSolver::solveFrom(const SurfacePoint& start,
                                                            const dvec3& scenePoint) const {
  const SearchResult found = searchReflectionPoint(
      mesh_->triangles(), start, eye_, scenePoint, std::min(options_.newtonSteps, kFewSteps),
      options_.tolerance, options_.longestStep * mesh_->radius());
  if (!found.converged) return std::nullopt;
  return placeSearched(found);
}

VirtualVertex VirtualObjectSolver::solveRefined(const dvec3& scenePoint, const SeedPixel& seed,
                                                double nearWeight) const {
  if (mesh_->isConvex())  // nothing behind a convex mirror is reflected: spare the search
    if (const auto hiding = findHidingPoint(scenePoint, true)) return mirrorHidden(*hiding, scenePoint);
  const SearchResult found =
      searchReflectionPoint(mesh_->triangles(), findSeed(seed, nearWeight), eye_, scenePoint,
                            options_.newtonSteps, options_.tolerance, options_.longestStep * mesh_->radius());
  VirtualVertex vertex = placeSearched(found);
  if (found.converged) return vertex;

  const MirrorLaw& law = found.law;
  const bool isOnSurface = law.distancePoint <= kOnSurface * mesh_->radius();
  if (isOnSurface && glm::dot(law.normal, eye_ - law.position) > 0) {
    vertex.virtualPosition = scenePoint;
    return vertex;
  }
  return placeUnreflected(found, scenePoint);
}

/// Step 4 of Refined, from where the search ended.
VirtualVertex VirtualObjectSolver::placeUnreflected(const SearchResult& end, const dvec3& scenePoint) const {
  if (const auto hiding = findHidingPoint(scenePoint, false)) return mirrorHidden(*hiding, scenePoint);
  // The map does not see what is hidden within a pixel of the shadow's edge.
  const MirrorLaw& law = end.law;
  const bool isOutside = isPastBoundary(end.at), isStraight = law.isStraight();
  if (isStraight && !isOutside && glm::dot(law.normal, law.toEye) > 0)
    return mirrorHidden(end.at, scenePoint);
  // Or only a longer skirt would reflect it, or hide it.
  if (!(isOutside ? law.hn > 0 || isStraight : law.hn > 0 && law.isWithin(kNearlySine))) return {};
  VirtualVertex vertex = placeSearched(end);
  vertex.kind = VertexKind::DoublyVirtual;
  return vertex;
}

VirtualVertex VirtualObjectSolver::solve(Solver solver, const dvec3& scenePoint) const {
  if (!canReflect_ || !isFinite(scenePoint)) return {};
  if (solver != Solver::Explosion && solver != Solver::Refined) return solveFound(scenePoint).checked();
  double nearWeight;
  const dvec2 coords = computeCoords(scenePoint, nearWeight);
  const VirtualVertex vertex = solver == Solver::Explosion
                                   ? solveExplosion(scenePoint, coords, nearWeight)
                                   : solveRefined(scenePoint, seedMap_.at(coords), nearWeight);
  return vertex.checked();
}

/// Vertices in blocks, so that the block's fetches from the seed map and from the triangles, which are
/// scattered over more memory than the cache holds, are under way while others are computed.
void VirtualObjectSolver::computeInOrder(const VertexSink& sink,
                                         std::span<const std::uint32_t> vertices) const {
  constexpr std::size_t kBlock = 32;
  const SeedPixel* seeds[kBlock];
  double weights[kBlock] = {};
  for (std::size_t first = 0; first < vertices.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, vertices.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const dvec3 point(sink.scenePoints[vertices[first + i]]);
      seeds[i] = &seedMap_.at(isFinite(point) ? computeCoords(point, weights[i]) : dvec2(0));
      __builtin_prefetch(seeds[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const char* record =
          reinterpret_cast<const char*>(&mesh_->triangles()[heavierTriangle(*seeds[i], weights[i])]);
      for (std::size_t line = 0; line < sizeof(MirrorTriangle); line += 64) __builtin_prefetch(record + line);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const dvec3 point(sink.scenePoints[vertices[first + i]]);
      sink.write(vertices[first + i],
                 isFinite(point) ? solveRefined(point, *seeds[i], weights[i]).checked() : VirtualVertex{});
    }
  }
}

std::optional<ReflectionPoint> VirtualObjectSolver::findReflectionPoint(Solver solver,
                                                                        const dvec3& scenePoint) const {
  if (solver != Solver::Explosion && solver != Solver::Refined) return describeFound(scenePoint);
  const VirtualVertex vertex = solve(solver, scenePoint);
  if (vertex.kind == VertexKind::None) return std::nullopt;
  const MirrorTriangle& t = mesh_->triangles()[vertex.at.triangle];
  const MirrorLaw law = evaluateMirrorLaw(t, vertex.at.u, vertex.at.v, eye_, scenePoint);
  const bool isOnSurface = law.distancePoint <= kOnSurface * mesh_->radius();
  ReflectionPoint point;
  point.position = vertex.position;
  point.normal = glm::normalize(law.normal);
  point.virtualPosition = vertex.virtualPosition;
  point.at = vertex.at;
  point.residual = isOnSurface ? 0.0 : std::sqrt(law.squaredSine());
  point.steps = vertex.steps;
  point.kind = vertex.kind;
  return point;
}

void VirtualObjectSolver::compute(Solver solver, std::span<const vec3> scenePoints,
                                  std::span<vec3> virtualPositions, std::span<VertexKind> kinds,
                                  std::span<vec3> reflectionPoints, std::span<const VertexBits> mayReflect,
                                  LanePlaces* places) const {
  assert(virtualPositions.size() == scenePoints.size() && kinds.size() == scenePoints.size());
  assert(reflectionPoints.empty() || reflectionPoints.size() == scenePoints.size());
  if (places != nullptr && places->size() != scenePoints.size()) places->assign(scenePoints.size(), {});
  const VertexSink sink{scenePoints, virtualPositions, kinds, reflectionPoints, places};
  constexpr std::size_t kRunsPerTask = 16, kRun = VertexRuns::kLength;
  const std::size_t runs = (scenePoints.size() + kRun - 1) / kRun;
  assert(mayReflect.empty() || mayReflect.size() == runs);
  core::parallelFor(runs, kRunsPerTask, [&](std::size_t firstRun, std::size_t endRun) {
    WaitingLanes waiting;
    for (std::size_t first = firstRun; first < endRun; first += kRunsPerTask) {
      std::uint32_t wanted[kRunsPerTask * kRun];
      std::size_t count = 0;
      for (std::size_t run = first; run < std::min(first + kRunsPerTask, endRun); ++run) {
        const std::size_t begin = run * kRun, length = std::min(kRun, scenePoints.size() - begin);
        const unsigned all = (1u << length) - 1;
        unsigned bits = mayReflect.empty() ? all : mayReflect[run] & all;
        if (bits != all) std::fill_n(&kinds[begin], length, VertexKind::None);
        for (; bits != 0; bits &= bits - 1)
          wanted[count++] = std::uint32_t(begin) + std::uint32_t(std::countr_zero(bits));
      }
      const std::span<const std::uint32_t> vertices(wanted, count);
      if (solver != Solver::Refined || !canReflect_)
        for (const std::uint32_t v : vertices) sink.write(v, solve(solver, dvec3(scenePoints[v])));
      else if (mesh_->isConvex())  // one root only: wherever a search begins, it ends there
        computeInLanes(sink, vertices, waiting);
      else
        computeInOrder(sink, vertices);
    }
    finishLanes(sink, waiting);
  });
}

}  // namespace catoptric::virtual_object
