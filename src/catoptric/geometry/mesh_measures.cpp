// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/mesh_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "catoptric/geometry/vertex_weld.h"

namespace catoptric::geometry {
namespace {

constexpr double kConvexSlope = 1e-3;        // radians
constexpr double kDivergenceShare = 0.5;     // of the bend that the vertex normals show
constexpr std::size_t kGlobalSamples = 128;  // triangles against all vertices

struct Edge {
  std::uint64_t key;  // lower and upper welded vertex
  std::uint32_t triangle;
  std::uint32_t opposite;  // vertex
  bool forward;            // runs from the lower to the upper vertex
};

struct TrianglePlane {
  dvec3 normal, point;
  double altitude;  // smallest, for the conditioning of the normal
};

TrianglePlane planeOf(const MeshView& mesh, std::size_t triangle) {
  const dvec3 a(mesh.positions[mesh.indices[3 * triangle]]),
      b(mesh.positions[mesh.indices[3 * triangle + 1]]), c(mesh.positions[mesh.indices[3 * triangle + 2]]);
  const dvec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c), 1e-300});
  return {length > 0 ? n / length : dvec3(0), (a + b + c) / 3.0, length / longest};
}

std::vector<Edge> collectEdges(const MeshView& mesh, std::span<const std::uint32_t> welded) {
  std::vector<Edge> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = welded[mesh.indices[i + k]], b = welded[mesh.indices[i + (k + 1) % 3]];
      const std::uint32_t opposite = mesh.indices[i + (k + 2) % 3];
      if (a == b) continue;
      edges.push_back(
          {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(i / 3), opposite, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return x.key != y.key ? x.key < y.key : x.triangle < y.triangle;
  });
  return edges;
}

/// Is `vertex` in front of the plane by more than rounding and the allowed slope? `noise` is the rounding of
/// a coordinate; through a thin triangle it tilts the plane. Where the vertex normals spread from `normal` at
/// the triangle to the vertex, the smooth surface bends back there, and a facet in front only tells that a
/// quad was cut along the wrong diagonal.
bool isInFront(const MeshView& mesh, const TrianglePlane& plane, const dvec3& normal, std::uint32_t vertex,
               double noise) {
  const dvec3 d = dvec3(mesh.positions[vertex]) - plane.point;
  const double height = glm::dot(plane.normal, d);
  if (height <= noise) return false;
  const double distance = glm::length(d);
  const double spread = glm::dot(dvec3(mesh.normals[vertex]) - normal, d) / distance;
  const double slope =
      kConvexSlope + kDivergenceShare * std::max(spread, 0.0) + 4 * noise / std::max(plane.altitude, 1e-300);
  return height > slope * distance + noise;
}

dvec3 meanNormal(const MeshView& mesh, std::size_t triangle) {
  dvec3 sum(0);
  for (int k = 0; k < 3; ++k) sum += dvec3(mesh.normals[mesh.indices[3 * triangle + k]]) / 3.0;
  return sum;
}

}  // namespace

BoundingSphere computeBoundingSphere(std::span<const vec3> points) {
  BoundingSphere best;
  if (points.empty()) return best;
  const auto farthestFrom = [&](const dvec3& from) {
    double largest = -1;
    dvec3 farthest(0);
    for (const vec3& point : points) {
      const dvec3 d = dvec3(point) - from;
      const double square = glm::dot(d, d);
      if (square > largest) largest = square, farthest = dvec3(point);
    }
    return std::pair(farthest, std::sqrt(largest));
  };
  const dvec3 first = farthestFrom(dvec3(points[0])).first;
  const dvec3 second = farthestFrom(first).first;
  dvec3 centre = 0.5 * (first + second);
  best.radius = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 48;
  for (int step = 0; step < kSteps; ++step) {
    const auto [point, radius] = farthestFrom(centre);
    if (radius < best.radius) best = {centre, radius};
    centre += (point - centre) * (1.0 / (step + 2.0)) * 0.5;
  }
  return best;
}

double computeDistanceToTriangle(const dvec3& point, const dvec3& a, const dvec3& b, const dvec3& c) {
  // Over the inside the foot of the perpendicular is nearest, else a point of an edge.
  const dvec3 normal = glm::cross(b - a, c - a);
  const double squaredArea = glm::dot(normal, normal);
  const auto isInside = [&](const dvec3& from, const dvec3& to) {
    return glm::dot(glm::cross(to - from, point - from), normal) >= 0.0;
  };
  if (squaredArea > 0.0 && isInside(a, b) && isInside(b, c) && isInside(c, a))
    return std::abs(glm::dot(point - a, normal)) / std::sqrt(squaredArea);
  const auto distanceToEdge = [&](const dvec3& from, const dvec3& to) {
    const dvec3 along = to - from;
    const double squared = glm::dot(along, along);
    const double t = squared > 0.0 ? std::clamp(glm::dot(point - from, along) / squared, 0.0, 1.0) : 0.0;
    return glm::length(point - (from + t * along));
  };
  return std::min({distanceToEdge(a, b), distanceToEdge(b, c), distanceToEdge(c, a)});
}

double computeArea(const MeshView& mesh) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
        c(mesh.positions[mesh.indices[i + 2]]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

bool isConvexMesh(const MeshView& mesh) {
  const std::size_t triangles = mesh.indices.size() / 3;
  if (triangles == 0) return false;
  core::Box box;
  double largest = 0;
  for (const vec3& p : mesh.positions) {
    box.add(dvec3(p));
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(double(p[i])));
  }
  const double noise = 1.2e-7 * largest;

  // Locally, edge by edge. Corners are joined by position alone: a crease inside the surface counts as well.
  const auto welded =
      weldVertices(mesh.positions, {},
                   {.positionTolerance = 1e-6 * box.radius() + 2 * noise + 1e-300, .normalTolerance = 1});
  const std::vector<Edge> edges = collectEdges(mesh, welded);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].key == edges[i].key) ++end;
    if (end - i > 2) return false;
    if (end - i == 2) {
      const Edge &a = edges[i], &b = edges[i + 1];
      if (a.forward == b.forward) return false;
      const auto bendsForward = [&](const Edge& from, const Edge& to) {
        return isInFront(mesh, planeOf(mesh, from.triangle), dvec3(mesh.normals[from.opposite]), to.opposite,
                         noise);
      };
      if (bendsForward(a, b) || bendsForward(b, a)) return false;
    }
    i = end;
  }
  // Globally, on a spread sample.
  const std::size_t samples = std::min(triangles, kGlobalSamples);
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t triangle = s * triangles / samples;
    const TrianglePlane plane = planeOf(mesh, triangle);
    const dvec3 normal = meanNormal(mesh, triangle);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
      if (isInFront(mesh, plane, normal, v, noise)) return false;
  }
  return true;
}

}  // namespace catoptric::geometry
