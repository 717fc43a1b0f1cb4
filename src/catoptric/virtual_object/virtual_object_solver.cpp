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
constexpr std::size_t kGrain = 512;

bool isFinite(const dvec3& p) {
  return std::isfinite(p.x + p.y + p.z);
}

SurfacePoint clampToTriangle(std::uint32_t triangle, double u, double v) {
  u = std::max(u, 0.0), v = std::max(v, 0.0);
  const double sum = u + v;
  if (sum > 1.0) u /= sum, v /= sum;
  return {triangle, u, v};
}

/// The point of an extension polygon's base edge on the radius through `coords`.
SurfacePoint findOnOuterEdge(const ReflectorMesh& mesh, const ExplosionMap& map, std::uint32_t triangle,
                             const dvec2& coords) {
  const dvec2 c = map.extensionCentre, direction = coords - c;
  double bestDistance = 1e300, bestT = 0.5;
  int bestEdge = 0;
  for (int k = 0; k < 3; ++k) {
    const dvec2 a = map.coords[mesh.corners()[3 * triangle + k]];
    const dvec2 b = map.coords[mesh.corners()[3 * triangle + (k + 1) % 3]];
    const dvec2 edge = b - a;
    const double denominator = direction.x * edge.y - direction.y * edge.x;
    if (std::abs(denominator) < 1e-15) continue;
    const double t =
        std::clamp(((a.x - c.x) * direction.y - (a.y - c.y) * direction.x) / denominator, 0.0, 1.0);
    const dvec2 away = a + t * edge - coords;
    const double distance = glm::dot(away, away);
    if (distance < bestDistance) bestDistance = distance, bestT = t, bestEdge = k;
  }
  if (bestEdge == 0) return {triangle, bestT, 0};
  if (bestEdge == 1) return {triangle, 1.0 - bestT, bestT};
  return {triangle, 0, 1.0 - bestT};
}

/// What a map says about a direction. `isExtension`: an extension polygon, or the skirt.
struct MapAnswer {
  SurfacePoint at;
  bool isExtension = true;
};

MapAnswer lookUp(const ReflectorMesh& mesh, const ExplosionMap& map, const dvec2& coords, bool clamped) {
  std::uint32_t id = map.idAt(coords);
  if (id == core::kNoId)
    id = map.idAt(coords * (1.0 - 2.0 / map.ids.width()));  // a rim pixel outside the circle
  if (id == core::kNoId) return {};
  const std::uint32_t triangle = id / 2;
  if (id & kExtensionBit) return {findOnOuterEdge(mesh, map, triangle, coords), true};
  const UvFromCoords& f = map.uvFromCoords[triangle];
  const double u = f.u0 + f.ux * coords.x + f.uy * coords.y, v = f.v0 + f.vx * coords.x + f.vy * coords.y;
  const bool isSkirt = mesh.triangles()[triangle].isSkirt();
  return {clamped ? clampToTriangle(triangle, u, v) : SurfacePoint{triangle, u, v}, isSkirt};
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
  setEye(eye);
}

void VirtualObjectSolver::setEye(const dvec3& eye) {
  eye_ = eye;
  canReflect_ = false;
  if (mesh_->triangles().empty() || !isFinite(eye)) return;
  canReflect_ = computeReflectedRays(*mesh_, eye, scratch_) > 0;
  if (!canReflect_) return;
  const double nearRadius = kNearSphere * mesh_->radius();
  const double farRadius = std::max(farRadius_, 2.0 * nearRadius);
  fillExplosionMap(*mesh_, eye, nearRadius, scratch_, nearMap_);
  fillExplosionMap(*mesh_, eye, farRadius, scratch_, farMap_);
  fillHiddenMap(*mesh_, eye, scratch_, hiddenMap_);
}

/// Step 1 of Explosion, step 4 of Refined. kind None if no triangle hides the point.
ReflectionPoint VirtualObjectSolver::solveHidden(const dvec3& scenePoint) const {
  ReflectionPoint result;
  const dvec3 toPoint = scenePoint - eye_;
  const double distance = glm::length(toPoint);
  if (!(distance > 0)) return result;
  const dvec2 coords = computeMapCoords(hiddenMap_.frame, toPoint / distance);
  const dvec2 px = (coords - hiddenMap_.lower) * hiddenMap_.pixelsPerUnit;
  const int n = hiddenMap_.ids.width();
  if (!(px.x >= 0 && px.y >= 0 && px.x <= n && px.y <= n)) return result;
  const int x = std::min(int(px.x), n - 1), y = std::min(int(px.y), n - 1);
  std::uint32_t id = hiddenMap_.ids.at(x, y);
  for (int k = 0; k < 9 && id == core::kNoId; ++k)  // a pixel at the outline may be covered in part only
    id = hiddenMap_.ids.at(std::clamp(x + k % 3 - 1, 0, n - 1), std::clamp(y + k / 3 - 1, 0, n - 1));
  if (id == core::kNoId) return result;

  const MirrorTriangle& t = mesh_->triangles()[id];
  const dvec3 facet = glm::cross(t.edge1, t.edge2);
  const double fraction = glm::dot(facet, t.position0 - eye_) / glm::dot(facet, toPoint);
  if (!(fraction > 0.0 && fraction < 1.0)) return result;
  const dvec3 inTriangle = eye_ + fraction * toPoint - t.position0;
  const double a = glm::dot(t.edge1, inTriangle), b = glm::dot(t.edge2, inTriangle);
  const SurfacePoint at = clampToTriangle(id, t.gram11 * a + t.gram12 * b, t.gram12 * a + t.gram22 * b);

  result.triangle = id;
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
  ReflectionPoint result = solveHidden(scenePoint);
  if (result.kind != VertexKind::None) return result;
  const dvec3 fromCentre = scenePoint - nearMap_.centre;
  const double distance = glm::length(fromCentre);
  const dvec3 direction = distance > 0 ? fromCentre / distance : nearMap_.frame.z;
  const dvec2 coords = computeMapCoords(nearMap_.frame, direction);
  const MapAnswer nearAnswer = lookUp(*mesh_, nearMap_, coords, false);
  const MapAnswer farAnswer = lookUp(*mesh_, farMap_, coords, false);
  const double w = computeNearWeight(distance, nearMap_.radius, farMap_.radius);
  const auto triangles = mesh_->triangles();
  const dvec3 nearVirtual =
      mirrorInPlaneAt(triangles[nearAnswer.at.triangle], nearAnswer.at.u, nearAnswer.at.v, scenePoint);
  const dvec3 farVirtual =
      mirrorInPlaneAt(triangles[farAnswer.at.triangle], farAnswer.at.u, farAnswer.at.v, scenePoint);
  result.virtualPosition = w * nearVirtual + (1.0 - w) * farVirtual;

  const MapAnswer& heavier = w >= 0.5 ? nearAnswer : farAnswer;
  const MirrorLaw law =
      evaluateMirrorLaw(triangles[heavier.at.triangle], heavier.at.u, heavier.at.v, eye_, scenePoint);
  result.position = law.position;
  result.normal = glm::normalize(law.normal);
  result.triangle = heavier.at.triangle;
  result.u = heavier.at.u, result.v = heavier.at.v;
  result.residual = law.sine;
  result.steps = 1;
  result.kind = heavier.isExtension ? VertexKind::DoublyVirtual : VertexKind::Reflected;
  return result;
}

/// Step 1 of Refined.
SurfacePoint VirtualObjectSolver::findSeed(const dvec3& scenePoint) const {
  const dvec3 fromCentre = scenePoint - nearMap_.centre;
  const double distance = glm::length(fromCentre);
  const dvec3 direction = distance > 0 ? fromCentre / distance : nearMap_.frame.z;
  const dvec2 coords = computeMapCoords(nearMap_.frame, direction);
  const double w = computeNearWeight(distance, nearMap_.radius, farMap_.radius);
  const SurfacePoint nearAt = lookUp(*mesh_, nearMap_, coords, true).at;
  const SurfacePoint farAt = lookUp(*mesh_, farMap_, coords, true).at;
  const auto triangles = mesh_->triangles();
  const MirrorTriangle& nearTriangle = triangles[nearAt.triangle];
  const MirrorTriangle& farTriangle = triangles[farAt.triangle];
  const dvec3 apart = farTriangle.position(farAt.u, farAt.v) - nearTriangle.position(nearAt.u, nearAt.v);
  SurfacePoint at = w >= 0.5 ? nearAt : farAt;
  const dvec3 displacement = w >= 0.5 ? (1.0 - w) * apart : -w * apart;
  const MirrorTriangle& t = triangles[at.triangle];
  const double x = glm::dot(t.edge1, displacement), y = glm::dot(t.edge2, displacement);
  walkOnMesh(triangles, at, t.gram11 * x + t.gram12 * y, t.gram12 * x + t.gram22 * y);
  return at;
}

ReflectionPoint VirtualObjectSolver::solveRefined(const dvec3& scenePoint) const {
  const auto triangles = mesh_->triangles();
  const SearchResult found =
      searchReflectionPoint(triangles, findSeed(scenePoint), eye_, scenePoint, options_.newtonSteps,
                            options_.tolerance, kLongestStep * mesh_->radius());
  const MirrorLaw& law = found.law;
  const bool isOnSurface =
      law.distancePoint <= kOnSurface * mesh_->radius() && glm::dot(law.normal, law.toEye) > 0;
  const MirrorTriangle& t = triangles[found.at.triangle];
  constexpr double kEdge = -1e-6;
  const bool isOutside =
      t.isSkirt() || found.at.u < kEdge || found.at.v < kEdge || found.at.u + found.at.v > 1 - kEdge;
  if (!found.converged && !isOnSurface) {
    ReflectionPoint hidden = solveHidden(scenePoint);
    hidden.steps = found.steps;
    // Not hidden either: a point that only a longer skirt would reflect, or one within a map pixel of the
    // shadow.
    const bool isUsable = std::isfinite(law.sine) && law.lambda > 0 && (isOutside || law.sine < 0.05);
    if (hidden.kind != VertexKind::None || !isUsable) return hidden;
  }
  ReflectionPoint result;
  result.position = law.position;
  result.normal = glm::normalize(law.normal);
  result.virtualPosition =
      isOnSurface && !found.converged ? scenePoint : eye_ - law.toEye * (law.distanceEye + law.distancePoint);
  result.triangle = found.at.triangle;
  result.u = found.at.u, result.v = found.at.v;
  result.residual = isOnSurface && !found.converged ? 0.0 : law.sine;
  result.steps = found.steps;
  result.kind =
      (found.converged || isOnSurface) && !isOutside ? VertexKind::Reflected : VertexKind::DoublyVirtual;
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
