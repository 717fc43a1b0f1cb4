// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/interval_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/reflection_point.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

using raster::VertexKind;

constexpr std::size_t kRays = 320;  // at most about twice as many
constexpr int kMostSteps = 16;
constexpr double kSine = 1e-5;             // between normal and half vector: found
constexpr double kLongestStep = 0.3;       // of the mesh's radius
constexpr double kFarthest = 1.0;          // of it: from a ray farther away no search begins
constexpr double kOutsideTriangle = 1e-6;  // barycentric slack
constexpr double kOnSurface = 1e-7;        // of the mesh's radius: a point this near lies on the mirror

template <class Vector>
void store(float (&to)[3][8], std::size_t lane, const Vector& v) {
  for (int k = 0; k < 3; ++k) to[k][lane] = float(v[k]);
}

}  // namespace

IntervalSearch::IntervalSearch(const ReflectorMesh& mesh, const dvec3& eye) : mesh_(&mesh), patches_(mesh) {
  setEye(eye);
}

void IntervalSearch::setEye(const dvec3& eye) {
  eye_ = eye;
  triangles_.clear();
  groups_.clear();
  const double x = eye.x + eye.y + eye.z;
  if (mesh_->triangles().empty() || !std::isfinite(x)) return;
  if (computeReflectedRays(*mesh_, eye, rays_) == 0) return;
  patches_.makeBeams(*mesh_, rays_, beams_);
  std::vector<std::uint32_t> front;
  for (std::uint32_t i = 0; i < mesh_->ordinaryCount(); ++i) {
    const MirrorTriangle& t = mesh_->triangles()[i];
    if (glm::dot(t.normal(1.0 / 3, 1.0 / 3), eye - t.position(1.0 / 3, 1.0 / 3)) > 0) front.push_back(i);
  }
  const std::size_t step = std::max<std::size_t>(1, front.size() / kRays);
  for (std::size_t i = step / 2; i < front.size(); i += step) triangles_.push_back(front[i]);
  while (triangles_.size() % kLanes != 0) triangles_.push_back(triangles_.back());
  groups_.resize(triangles_.size() / kLanes);
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    storeRay(mesh_->triangles()[triangles_[i]], i % kLanes, groups_[i / kLanes]);
}

void IntervalSearch::storeRay(const MirrorTriangle& t, std::size_t lane, RayGroup& group) const {
  const dvec3 r0 = reflectAt(t, 0, 0, eye_);
  store(group.origin, lane, t.position(1.0 / 3, 1.0 / 3) - mesh_->centre());
  store(group.direction, lane, reflectAt(t, 1.0 / 3, 1.0 / 3, eye_));
  store(group.originU, lane, t.edge1), store(group.originV, lane, t.edge2);
  store(group.directionU, lane, reflectAt(t, 1, 0, eye_) - r0);
  store(group.directionV, lane, reflectAt(t, 0, 1, eye_) - r0);
  const auto foci = findFocalDistances(t, eye_);
  group.focus1[lane] = float(foci[0]), group.focus2[lane] = float(foci[1]);
}

/// Steps 3 and 4.
IntervalSearch::Vertex IntervalSearch::search(std::uint32_t triangle, const dvec3& scenePoint,
                                              std::size_t interval) const {
  const SearchResult found =
      searchReflectionPoint(mesh_->triangles(), SurfacePoint{triangle}, eye_, scenePoint, kMostSteps, kSine,
                            kLongestStep * mesh_->radius());
  const MirrorLaw& law = found.law;
  if (!found.converged) {
    const bool isOn =
        law.distancePoint <= kOnSurface * mesh_->radius() && glm::dot(law.normal, eye_ - law.position) > 0;
    return isOn && interval == 0
               ? Vertex{vec3(scenePoint), vec3(law.position), found.at.triangle, VertexKind::Reflected}
               : Vertex{};
  }
  const MirrorTriangle& t = mesh_->triangles()[found.at.triangle];
  if (findInterval(t, eye_, found.at.u, found.at.v, law.distancePoint) != interval) return {};
  const bool isPastBoundary =
      t.isSkirt() || std::min({found.at.u, found.at.v, 1.0 - found.at.u - found.at.v}) < -kOutsideTriangle;
  return {vec3(eye_ - law.toEye * (law.distanceEye + law.distancePoint)), vec3(law.position),
          found.at.triangle, isPastBoundary ? VertexKind::PastBoundary : VertexKind::Reflected};
}

std::optional<dvec3> IntervalSearch::find(const dvec3& scenePoint, std::size_t interval) const {
  if (!canReflect()) return std::nullopt;
  std::array<Start, kIntervals> starts;
  findStarts(groups_, vec3(scenePoint - mesh_->centre()), starts);
  const double farthest = kFarthest * mesh_->radius();
  if (!(starts[interval].squared < farthest * farthest)) return std::nullopt;
  const Vertex vertex = search(triangles_[starts[interval].ray], scenePoint, interval);
  return vertex.kind == VertexKind::Reflected ? std::optional(dvec3(vertex.reflectionPoint)) : std::nullopt;
}

void IntervalSearch::compute(std::span<const vec3> scenePoints, std::span<const VertexBits> mayReflect,
                             const std::array<bool, kIntervals>& wanted,
                             std::array<IntervalVertices, kIntervals>& found) const {
  for (std::size_t k = 0; k < kIntervals; ++k) {
    if (!wanted[k]) continue;
    found[k].positions.resize(scenePoints.size());
    found[k].reflectionPoints.resize(scenePoints.size());
    found[k].triangles.resize(scenePoints.size());
    found[k].kinds.assign(scenePoints.size(), VertexKind::None);
  }
  constexpr std::size_t kRun = VertexRuns::kLength;
  const float farthest = float(kFarthest * kFarthest * mesh_->radius() * mesh_->radius());
  core::parallelFor((scenePoints.size() + kRun - 1) / kRun, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t run = first; run < last; ++run) {
      for (std::size_t i = run * kRun; i < std::min(scenePoints.size(), (run + 1) * kRun); ++i) {
        if (!mayReflect.empty() && (mayReflect[run] >> i % kRun & 1u) == 0) continue;
        const dvec3 point(scenePoints[i]);
        if (!std::isfinite(point.x + point.y + point.z)) continue;
        std::array<Start, kIntervals> starts;
        findStarts(groups_, vec3(point - mesh_->centre()), starts);
        for (std::size_t k = 0; k < kIntervals; ++k) {
          if (!wanted[k] || !(starts[k].squared < farthest)) continue;
          const Vertex vertex = search(triangles_[starts[k].ray], point, k);
          found[k].positions[i] = vertex.position, found[k].kinds[i] = vertex.kind;
          found[k].reflectionPoints[i] = vertex.reflectionPoint, found[k].triangles[i] = vertex.triangle;
        }
      }
    }
  });
}

void markIntervalTriangles(const raster::TessellatedObjects& objects, const IntervalVertices& vertices,
                           std::vector<std::uint8_t>& isKept) {
  isKept.resize(objects.indices.size() / 3);
  core::parallelFor(isKept.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto isFound = [&](std::size_t k) {
        return vertices.kinds[objects.indices[3 * t + k]] != VertexKind::None;
      };
      isKept[t] = isFound(0) && isFound(1) && isFound(2) ? 1 : 0;
    }
  });
}

}  // namespace catoptric::virtual_object
