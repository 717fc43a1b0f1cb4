// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/reflection_subdivision.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/polynomial.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kInside = -1e-10;  // barycentric slack: a point between two cells lies in one of them
constexpr int kNewtonSteps = 16;
constexpr double kTolerance = 1e-10;  // sine of the angle between normal and half vector
constexpr double kLongestStep = 0.3;  // of the mesh's radius
constexpr double kOutsideTriangle = 1e-6;

}  // namespace

void ReflectionSubdivision::build(const ReflectorMesh& mesh, const dvec3& eye, const ReflectedRays& rays) {
  mesh_ = &mesh;
  eye_ = eye;
  rays_.clear(), reflecting_.clear();
  std::vector<RayConeTree::Cell> reflected, hidden;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    RayConeTree::Cell cell{.id = t, .starts = {}, .directions = {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.corners()[3 * t + k];
      cell.starts[k] = mesh.positions()[v];
      cell.directions[k] = rays.directions[v];
      rays_.push_back(cell.directions[k]);
    }
    if (!rays.isMapped[t]) continue;
    reflecting_.push_back(t);
    reflected.push_back(cell);
    if (mesh.triangles()[t].isSkirt()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      cell.directions[k] = glm::normalize(cell.starts[k] - eye);
      cell.starts[k] = eye;
    }
    hidden.push_back(cell);
  }
  reflected_.build(reflected);
  hidden_.build(hidden);
}

/// Step 2: calls add(CellPoint) for each time the travelling triangle passes over the point.
template <class Add>
void ReflectionSubdivision::testCell(std::uint32_t triangle, const dvec3& point, const Add& add) const {
  const MirrorTriangle& m = mesh_->triangles()[triangle];
  const dvec3* ray = &rays_[3 * std::size_t(triangle)];
  // Corner 0 relative to Q and the two edges, each linear in t.
  const dvec3 a0 = m.position0 - point, a1 = ray[0], b0 = m.edge1, b1 = ray[1] - ray[0], c0 = m.edge2,
              c1 = ray[2] - ray[0];
  const dvec3 n0 = glm::cross(b0, c0), n1 = glm::cross(b0, c1) + glm::cross(b1, c0), n2 = glm::cross(b1, c1);
  const double cubic[4] = {glm::dot(a0, n0), glm::dot(a1, n0) + glm::dot(a0, n1),
                           glm::dot(a1, n1) + glm::dot(a0, n2), glm::dot(a1, n2)};
  for (const double t : core::findRealRoots(cubic)) {
    if (!(t >= 0)) continue;
    const dvec3 e1 = b0 + t * b1, e2 = c0 + t * c1, d = -(a0 + t * a1);
    const double g11 = glm::dot(e1, e1), g12 = glm::dot(e1, e2), g22 = glm::dot(e2, e2);
    const double x = glm::dot(e1, d), y = glm::dot(e2, d), inverse = 1.0 / (g11 * g22 - g12 * g12);
    const double u = (g22 * x - g12 * y) * inverse, v = (g11 * y - g12 * x) * inverse;
    if (u >= kInside && v >= kInside && 1.0 - u - v >= kInside) add(CellPoint{{triangle, u, v}, t});
  }
}

void ReflectionSubdivision::findReflectedCells(const dvec3& point, std::vector<CellPoint>& found) const {
  found.clear();
  reflected_.forCandidates(point, [&](std::uint32_t triangle) {
    testCell(triangle, point, [&](const CellPoint& cell) { found.push_back(cell); });
  });
  std::sort(found.begin(), found.end(), [](const CellPoint& a, const CellPoint& b) {
    return a.travel != b.travel ? a.travel < b.travel : a.at.triangle < b.at.triangle;
  });
}

void ReflectionSubdivision::findReflectedCellsByAll(const dvec3& point, std::vector<CellPoint>& found) const {
  found.clear();
  for (const std::uint32_t triangle : reflecting_)
    testCell(triangle, point, [&](const CellPoint& cell) { found.push_back(cell); });
  std::sort(found.begin(), found.end(), [](const CellPoint& a, const CellPoint& b) {
    return a.travel != b.travel ? a.travel < b.travel : a.at.triangle < b.at.triangle;
  });
}

std::optional<CellPoint> ReflectionSubdivision::findReflectedCell(const dvec3& point) const {
  std::optional<CellPoint> nearest;
  // On an open mirror a cell of the skirt gives way to one of the mirror itself.
  const auto isSkirt = [&](const CellPoint& cell) { return mesh_->triangles()[cell.at.triangle].isSkirt(); };
  reflected_.forCandidates(point, [&](std::uint32_t triangle) {
    testCell(triangle, point, [&](const CellPoint& cell) {
      const bool isBetter = !nearest || (isSkirt(cell) != isSkirt(*nearest) ? isSkirt(*nearest)
                                                                            : cell.travel < nearest->travel);
      if (isBetter) nearest = cell;
    });
  });
  return nearest;
}

std::optional<CellPoint> ReflectionSubdivision::findHiddenCell(const dvec3& point) const {
  std::optional<CellPoint> nearest;
  double nearestFraction = 1;
  const dvec3 toPoint = point - eye_;
  hidden_.forCandidates(point, [&](std::uint32_t triangle) {
    const MirrorTriangle& m = mesh_->triangles()[triangle];
    const dvec3 facet = glm::cross(m.edge1, m.edge2);
    const double fraction = glm::dot(facet, m.position0 - eye_) / glm::dot(facet, toPoint);
    if (!(fraction > 0 && fraction < nearestFraction)) return;
    const dvec2 uv = m.project(eye_ + fraction * toPoint);
    if (uv.x < kInside || uv.y < kInside || 1.0 - uv.x - uv.y < kInside) return;
    nearestFraction = fraction;
    nearest = CellPoint{{triangle, uv.x, uv.y}, (1.0 - fraction) * glm::length(toPoint)};
  });
  return nearest;
}

void SubdivisionFinder::setEye(const EyeView& view) {
  eye_ = view.eye;
  subdivision_.build(*mesh_, view.eye, *view.rays);
}

std::optional<FoundPoint> SubdivisionFinder::find(const dvec3& scenePoint) const {
  FoundPoint found;
  const auto describe = [&](const SurfacePoint& at) {
    const MirrorTriangle& t = mesh_->triangles()[at.triangle];
    found.at = at;
    found.position = t.position(at.u, at.v);
    found.normal = glm::normalize(t.normal(at.u, at.v));
    const bool isOutside = std::min({at.u, at.v, 1.0 - at.u - at.v}) < -kOutsideTriangle;
    found.isPastBoundary = t.isSkirt() || isOutside;
  };
  if (mesh_->isConvex())
    if (const auto hidden = subdivision_.findHiddenCell(scenePoint)) {
      describe(hidden->at);
      found.isHidden = true;
      return found;
    }
  if (const auto cell = subdivision_.findReflectedCell(scenePoint)) {
    const SearchResult result =
        searchReflectionPoint(mesh_->triangles(), cell->at, eye_, scenePoint, kNewtonSteps, kTolerance,
                              kLongestStep * mesh_->radius());
    if (result.converged) {
      describe(result.at);
      return found;
    }
  }
  if (const auto hidden = subdivision_.findHiddenCell(scenePoint)) {
    describe(hidden->at);
    found.isHidden = true;
    return found;
  }
  return std::nullopt;
}

}  // namespace catoptric::virtual_object
