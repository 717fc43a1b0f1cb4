// SPDX-License-Identifier: Apache-2.0
// Virtual vertices by explosion maps (Ofek & Rappoport 1998, fig. 7) and by a Newton search that starts from
// them.
//
// Explosion:
//   1. Hidden? Look Q up in the hidden map; if the triangle V there hides it, mirror Q in the plane that V
//   has where
//      the ray E -> Q meets it. Such a vertex comes to lie outside the mirror's image, or in front of its
//      surface.
//   2. MapCoords of the direction centre -> Q, the same for both maps.
//   3. In each map: triangle, barycentrics in its mapped 2-D triangle, plane there, mirror Q in it. In an
//   extension
//      polygon: the point of the triangle's outer edge on the same radius.
//   4. Blend with weights 1/d_near, 1/d_far of *relative* distances, that is, linearly in 1/|Q - C|.
// Refined:
//   1. The two reflection points of steps 2 and 3; walk from the heavier one over the mesh towards their
//   blend.
//   2. Newton on the mirror law across triangle edges (reflection_point.h).
//   3. Q' on the ray E -> J at |EJ| + |JQ|. J in the skirt: doubly virtual.
//   4. No root: hidden, as in Explosion step 1; it meets the reflected ones smoothly both at the line where
//   an object
//      touches the mirror and at the rim (README).
//
// Failures: see README. Cost per vertex and core: about 0.1 us Explosion, 0.2 to 0.3 us Refined.
#include "catoptric/virtual_object/virtual_object_solver.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/reflection_point.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kNearSphere = 1.02;       // of the mesh's radius: slightly enlarged
constexpr double kOnSurface = 1e-7;        // of the mesh's radius: a point this near lies on the mirror
constexpr double kLongestStep = 0.7;       // of the mesh's radius
constexpr double kLongestMirroring = 0.5;  // of the distance eye - mirror: keeps Q' in front of the eye
constexpr double kNearlySine = 0.05;       // a root this near is good enough to place a doubly virtual vertex
constexpr double kOutsideTriangle = 1e-6;  // barycentric slack
constexpr std::size_t kGrain = 512;

bool isFinite(const dvec3& p) {
  return std::isfinite(p.x + p.y + p.z);
}

/// Weight of the near map: linear in 1/|Q - C| (relative distances, methods.md section 1).
double computeNearWeight(double distance, double nearRadius, double farRadius) {
  if (distance <= nearRadius) return 1.0;
  if (distance >= farRadius) return 0.0;
  return (1.0 / distance - 1.0 / farRadius) / (1.0 / nearRadius - 1.0 / farRadius);
}

dvec3 mirrorInPlaneAt(const MirrorTriangle& t, double u, double v, const dvec3& point) {
  const dvec3 normal = glm::normalize(t.normal(u, v));
  return point - 2.0 * glm::dot(point - t.position(u, v), normal) * normal;
}

}  // namespace

VirtualObjectSolver::VirtualObjectSolver(const ReflectorMesh& mesh, const dvec3& eye, double farRadius,
                                         const SolverOptions& options)
    : mesh_(&mesh), farRadius_(farRadius), options_(options) {
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
  core::parallelFor(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i == 0) fillExplosionMap(*mesh_, eye, nearRadius, rays_, scratch_[0], nearMap_);
      if (i == 1) fillExplosionMap(*mesh_, eye, farRadius, rays_, scratch_[1], farMap_);
      if (i == 2) fillHiddenMap(*mesh_, eye, scratch_[2], hiddenMap_);
    }
  });
  fillSeedMap(*mesh_, nearMap_, farMap_, seedMap_);
}

/// Where the ray to the point meets the triangle that hides the point from the eye; nothing if none does.
/// `surely`: only where the hidden map's resolution leaves no doubt.
std::optional<SurfacePoint> VirtualObjectSolver::findHidingPoint(const dvec3& scenePoint, bool surely) const {
  const dvec3 toPoint = scenePoint - eye_;
  const double along = glm::dot(toPoint, hiddenMap_.frame.z), squared = glm::dot(toPoint, toPoint);
  if (!(along > 0) || along * along < hiddenMap_.squaredCosine * squared) return std::nullopt;  // beside it
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
ReflectionPoint VirtualObjectSolver::mirrorHidden(const SurfacePoint& at, const dvec3& scenePoint) const {
  ReflectionPoint result;
  const MirrorTriangle& t = mesh_->triangles()[at.triangle];
  result.triangle = at.triangle;
  result.u = at.u, result.v = at.v;
  result.position = t.position(at.u, at.v);
  result.normal = glm::normalize(t.normal(at.u, at.v));
  const dvec3 behind = scenePoint - result.position;
  const double depth = glm::length(behind);
  const double longest = kLongestMirroring * glm::length(result.position - eye_);
  const dvec3 mirrored = core::reflectDirection(behind, result.normal);
  result.virtualPosition = result.position + mirrored * (depth > longest ? longest / depth : 1.0);
  result.kind = VertexKind::DoublyVirtual;
  return result;
}

ReflectionPoint VirtualObjectSolver::solveExplosion(const dvec3& scenePoint) const {
  if (const auto hiding = findHidingPoint(scenePoint, false)) return mirrorHidden(*hiding, scenePoint);
  const dvec3 fromCentre = scenePoint - nearMap_.centre;
  const double distance = glm::length(fromCentre);
  const dvec3 direction = distance > 0 ? fromCentre / distance : nearMap_.frame.z;
  const dvec2 coords = computeMapCoords(nearMap_.frame, direction);
  const MapAnswer nearAnswer = lookUpMap(*mesh_, nearMap_, coords);
  const MapAnswer farAnswer = lookUpMap(*mesh_, farMap_, coords);
  const double w = computeNearWeight(distance, nearMap_.radius, farMap_.radius);
  const auto triangles = mesh_->triangles();
  const dvec3 nearVirtual =
      mirrorInPlaneAt(triangles[nearAnswer.at.triangle], nearAnswer.at.u, nearAnswer.at.v, scenePoint);
  const dvec3 farVirtual =
      mirrorInPlaneAt(triangles[farAnswer.at.triangle], farAnswer.at.u, farAnswer.at.v, scenePoint);
  ReflectionPoint result;
  result.virtualPosition = w * nearVirtual + (1.0 - w) * farVirtual;

  const MapAnswer& heavier = w >= 0.5 ? nearAnswer : farAnswer;
  const MirrorLaw law =
      evaluateMirrorLaw(triangles[heavier.at.triangle], heavier.at.u, heavier.at.v, eye_, scenePoint);
  result.position = law.position;
  result.normal = glm::normalize(law.normal);
  result.triangle = heavier.at.triangle;
  result.u = heavier.at.u, result.v = heavier.at.v;
  result.residual = std::sqrt(law.squaredSine());
  result.steps = 1;
  result.kind = heavier.isExtension ? VertexKind::DoublyVirtual : VertexKind::Reflected;
  return result;
}

/// Step 1 of Refined.
SurfacePoint VirtualObjectSolver::findSeed(const dvec3& scenePoint) const {
  const dvec3 fromCentre = scenePoint - nearMap_.centre;
  const double distance = std::sqrt(glm::dot(fromCentre, fromCentre));
  const dvec3 direction = distance > 0 ? fromCentre * (1.0 / distance) : nearMap_.frame.z;
  const SeedPixel& seed = seedMap_.at(computeMapCoords(nearMap_.frame, direction));
  const double w = computeNearWeight(distance, nearMap_.radius, farMap_.radius);
  const dvec3 blend = w * dvec3(seed.nearPosition) + (1.0 - w) * dvec3(seed.farPosition);
  SurfacePoint at{w >= 0.5 ? seed.nearTriangle : seed.farTriangle};
  const dvec2 target = mesh_->triangles()[at.triangle].project(blend);
  walkOnMesh(mesh_->triangles(), at, target.x - at.u, target.y - at.v);
  return at;
}

ReflectionPoint VirtualObjectSolver::solveRefined(const dvec3& scenePoint) const {
  const bool isConvex = mesh_->isConvex();
  if (isConvex)  // nothing behind a convex mirror is reflected: spare the search
    if (const auto hiding = findHidingPoint(scenePoint, true)) return mirrorHidden(*hiding, scenePoint);
  const SearchResult found =
      searchReflectionPoint(mesh_->triangles(), findSeed(scenePoint), eye_, scenePoint, options_.newtonSteps,
                            options_.tolerance, kLongestStep * mesh_->radius());
  const MirrorLaw& law = found.law;
  const bool isOnSurface = !found.converged && law.distancePoint <= kOnSurface * mesh_->radius() &&
                           glm::dot(law.normal, law.toEye) > 0;
  const bool isPastBoundary =
      mesh_->triangles()[found.at.triangle].isSkirt() ||
      std::min({found.at.u, found.at.v, 1.0 - found.at.u - found.at.v}) < -kOutsideTriangle;
  if (!found.converged && !isOnSurface) {
    if (const auto hiding = findHidingPoint(scenePoint, false)) return mirrorHidden(*hiding, scenePoint);
    // Not hidden either: only a longer skirt would reflect it, or it is within a map pixel of the shadow.
    if (!(law.hn > 0 && (isPastBoundary || law.isWithin(kNearlySine)))) return {};
  }
  ReflectionPoint result;
  result.position = law.position;
  result.normal = glm::normalize(law.normal);
  result.virtualPosition =
      isOnSurface ? scenePoint : eye_ - law.toEye * (law.distanceEye + law.distancePoint);
  result.triangle = found.at.triangle;
  result.u = found.at.u, result.v = found.at.v;
  result.residual = isOnSurface ? 0.0 : std::sqrt(law.squaredSine());
  result.steps = found.steps;
  const bool isReflected = (found.converged || isOnSurface) && !isPastBoundary;
  result.kind = isReflected ? VertexKind::Reflected : VertexKind::DoublyVirtual;
  return result;
}

ReflectionPoint VirtualObjectSolver::solve(Solver solver, const dvec3& scenePoint) const {
  if (!canReflect_ || !isFinite(scenePoint)) return {};
  ReflectionPoint result =
      solver == Solver::Explosion ? solveExplosion(scenePoint) : solveRefined(scenePoint);
  if (!isFinite(result.virtualPosition) || !isFinite(result.position)) return {};
  return result;
}

std::optional<ReflectionPoint> VirtualObjectSolver::findReflectionPoint(Solver solver,
                                                                        const dvec3& scenePoint) const {
  const ReflectionPoint result = solve(solver, scenePoint);
  if (result.kind == VertexKind::None) return std::nullopt;
  return result;
}

void VirtualObjectSolver::compute(Solver solver, std::span<const vec3> scenePoints,
                                  std::span<vec3> virtualPositions, std::span<VertexKind> kinds,
                                  std::span<vec3> reflectionPoints) const {
  assert(virtualPositions.size() == scenePoints.size() && kinds.size() == scenePoints.size());
  assert(reflectionPoints.empty() || reflectionPoints.size() == scenePoints.size());
  core::parallelFor(scenePoints.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ReflectionPoint point = solve(solver, dvec3(scenePoints[i]));
      const bool isUsable = point.kind != VertexKind::None;
      virtualPositions[i] = isUsable ? vec3(point.virtualPosition) : scenePoints[i];
      kinds[i] = point.kind;
      if (!reflectionPoints.empty()) reflectionPoints[i] = isUsable ? vec3(point.position) : scenePoints[i];
    }
  });
}

}  // namespace catoptric::virtual_object
