// SPDX-License-Identifier: Apache-2.0
// VirtualObjectSolver with a PointFinder: from a reflection point to a virtual vertex.
//   1. Finders that do not know hidden points: ask the hidden map, as Refined does.
//   2. The finder. Reflected: Q' on the ray E -> J at |EJ| + |JQ|. Past the boundary: doubly virtual.
//   3. Not reflected: if it is hidden, mirrored where the ray E -> Q enters; otherwise None.
#include <algorithm>
#include <cmath>

#include "catoptric/virtual_object/formulas.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kOnSurface = 1e-7;  // of the mesh's radius: a point this near lies on the mirror

}  // namespace

void VirtualObjectSolver::useFinder(std::unique_ptr<PointFinder> finder) {
  finder_ = std::move(finder);
  if (finder_ && canReflect_) finder_->setEye(eyeView());
}

EyeView VirtualObjectSolver::eyeView() const {
  return {eye_, nearMap_.radius, farMap_.radius, &rays_};
}

VirtualVertex VirtualObjectSolver::solveFound(const dvec3& scenePoint) const {
  if (!finder_) return {};
  // 1
  if (!finder_->knowsHiddenPoints() && mesh_->isConvex())
    if (const auto hiding = findHidingPoint(scenePoint, true)) return mirrorHidden(*hiding, scenePoint);
  // 2
  const auto found = finder_->find(scenePoint);
  if (found && found->isHidden) return mirrorHidden(found->at, scenePoint);
  if (found) {
    const dvec3 onward = scenePoint - found->position;
    const bool isInFront =
        glm::dot(found->normal, onward) > 0 || glm::length(onward) <= kOnSurface * mesh_->radius();
    if (isInFront) {
      const VertexKind kind = found->isPastBoundary ? VertexKind::PastBoundary : VertexKind::Reflected;
      return {formulas::placeBehind(eye_, found->position, scenePoint), found->position, found->at, 1, kind};
    }
  }
  // 3
  if (const auto hiding = findHidingPoint(scenePoint, false)) return mirrorHidden(*hiding, scenePoint);
  return {};
}

std::optional<ReflectionPoint> VirtualObjectSolver::describeFound(const dvec3& scenePoint) const {
  const VirtualVertex vertex = solve(Solver::Analytic, scenePoint);
  if (vertex.kind == VertexKind::None) return std::nullopt;
  ReflectionPoint point;
  point.position = vertex.position;
  point.virtualPosition = vertex.virtualPosition;
  point.at = vertex.at;
  point.steps = vertex.steps;
  point.kind = vertex.kind;
  const auto found = finder_->find(scenePoint);
  if (!found) return point;
  point.normal = found->normal;
  const dvec3 half = glm::normalize(eye_ - found->position) + glm::normalize(scenePoint - found->position);
  point.residual = glm::length(glm::cross(glm::normalize(half), found->normal));
  return point;
}

}  // namespace catoptric::virtual_object
