// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/polyhedra.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace catoptric::geometry {
namespace {

std::vector<dvec3> polyhedronCorners(Polyhedron kind) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0)), i = 1.0 / g;
  switch (kind) {
    case Polyhedron::Tetrahedron:
      return {{0, 1, 0},
              {std::sqrt(8.0 / 9), -1.0 / 3, 0},
              {-std::sqrt(2.0 / 9), -1.0 / 3, std::sqrt(2.0 / 3)},
              {-std::sqrt(2.0 / 9), -1.0 / 3, -std::sqrt(2.0 / 3)}};
    case Polyhedron::Cube:
      return {{1, 1, 1},  {1, 1, -1},  {1, -1, 1},  {1, -1, -1},
              {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};
    case Polyhedron::Octahedron:
      return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    case Polyhedron::Dodecahedron:
      return {{1, 1, 1},    {1, 1, -1},  {1, -1, 1}, {1, -1, -1}, {-1, 1, 1},  {-1, 1, -1}, {-1, -1, 1},
              {-1, -1, -1}, {0, i, g},   {0, i, -g}, {0, -i, g},  {0, -i, -g}, {i, g, 0},   {i, -g, 0},
              {-i, g, 0},   {-i, -g, 0}, {g, 0, i},  {-g, 0, i},  {g, 0, -i},  {-g, 0, -i}};
    case Polyhedron::Icosahedron:
      return {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  }
  return {};
}

/// Adds the facet through the points `on`, which all lie in the plane of `normal`, as a fan around its first
/// corner.
void addFacet(Mesh& mesh, const std::vector<dvec3>& points, std::vector<std::size_t> on,
              const dvec3& normal) {
  dvec3 middle(0);
  for (std::size_t i : on) middle += points[i] / double(on.size());
  const dvec3 right = glm::normalize(points[on[0]] - middle), up = glm::cross(normal, right);
  const auto angle = [&](std::size_t i) {
    return std::atan2(glm::dot(points[i] - middle, up), glm::dot(points[i] - middle, right));
  };
  std::sort(on.begin(), on.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  const auto first = std::uint32_t(mesh.positions.size());
  for (std::size_t i : on) {
    mesh.positions.push_back(vec3(points[i]));
    mesh.normals.push_back(vec3(normal));
  }
  for (std::uint32_t k = 1; k + 1 < on.size(); ++k)
    mesh.indices.insert(mesh.indices.end(), {first, first + k, first + k + 1});
}

}  // namespace

Mesh makeConvexHull(const std::vector<dvec3>& points) {
  assert(points.size() >= 4);
  Mesh mesh;
  std::set<std::vector<std::size_t>> done;
  double scale = 0;
  for (const dvec3& p : points) scale = std::max(scale, glm::length(p));
  const double tolerance = 1e-9 * scale;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < points.size(); ++b)
      for (std::size_t c = 0; c < points.size(); ++c) {
        if (a >= b || a >= c || b == c) continue;
        const dvec3 cross = glm::cross(points[b] - points[a], points[c] - points[a]);
        if (glm::length(cross) <= tolerance * scale) continue;
        const dvec3 normal = glm::normalize(cross);
        std::vector<std::size_t> on;
        bool isOutside = false;
        for (std::size_t i = 0; i < points.size() && !isOutside; ++i) {
          const double height = glm::dot(points[i] - points[a], normal);
          isOutside = height > tolerance;
          if (std::abs(height) <= tolerance) on.push_back(i);
        }
        if (!isOutside && done.insert(on).second) addFacet(mesh, points, on, normal);
      }
  return mesh;
}

Mesh makePolyhedron(Polyhedron kind, double circumradius) {
  std::vector<dvec3> corners = polyhedronCorners(kind);
  for (dvec3& c : corners) c = circumradius * glm::normalize(c);
  return makeConvexHull(corners);
}

}  // namespace catoptric::geometry
