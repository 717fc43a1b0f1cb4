// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/mesh_inspection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace catoptric::geometry {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct EdgeUse {
  std::uint32_t triangle;
  bool forwards;           // runs from the smaller to the larger vertex
  std::uint32_t opposite;  // the triangle's third corner
};

std::array<dvec3, 3> corners(const Mesh& mesh, std::size_t triangle) {
  std::array<dvec3, 3> p;
  for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[3 * triangle + k]];
  return p;
}

dvec3 planeNormal(const std::array<dvec3, 3>& p) {
  const dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double length = glm::length(cross);
  return length > 0 ? cross / length : dvec3(0);
}

/// Vertices merged by place alone, whatever their normals: the topology of the surface.
std::vector<std::uint32_t> mergeByPosition(const Mesh& mesh, double tolerance) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return mesh.positions[a].x < mesh.positions[b].x;
  });
  std::vector<std::uint32_t> representative(order.size(), 0xffffffffu);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (representative[order[i]] != 0xffffffffu) continue;
    representative[order[i]] = order[i];
    const dvec3 p = mesh.positions[order[i]];
    for (std::size_t j = i + 1; j < order.size() && mesh.positions[order[j]].x - p.x <= tolerance; ++j)
      if (glm::distance(p, dvec3(mesh.positions[order[j]])) <= tolerance) representative[order[j]] = order[i];
  }
  return representative;
}

std::map<Edge, std::vector<EdgeUse>> collectEdges(const Mesh& mesh, double tolerance) {
  const std::vector<std::uint32_t> place = mergeByPosition(mesh, tolerance);
  std::map<Edge, std::vector<EdgeUse>> uses;
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = place[mesh.indices[3 * t + k]], b = place[mesh.indices[3 * t + (k + 1) % 3]];
      uses[{std::min(a, b), std::max(a, b)}].push_back({t, a < b, place[mesh.indices[3 * t + (k + 2) % 3]]});
    }
  return uses;
}

}  // namespace

EdgeReport inspectEdges(const Mesh& mesh, double positionTolerance) {
  EdgeReport report;
  for (const auto& [edge, uses] : collectEdges(mesh, positionTolerance)) {
    if (uses.size() == 1)
      ++report.boundary;
    else if (uses.size() > 2)
      ++report.nonManifold;
    else if (uses[0].forwards == uses[1].forwards)
      ++report.inconsistent;
    else
      ++report.interior;
  }
  return report;
}

double computeSignedVolume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto p = corners(mesh, t);
    sum += glm::dot(p[0], glm::cross(p[1], p[2]));
  }
  return sum / 6;
}

double findLargestNormalDeviation(const Mesh& mesh) {
  double largest = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const dvec3 face = planeNormal(corners(mesh, t));
    for (int k = 0; k < 3; ++k) {
      const dvec3 n = mesh.normals[mesh.indices[3 * t + k]];
      largest = std::max(largest, std::atan2(glm::length(glm::cross(face, n)), glm::dot(face, n)));
    }
  }
  return largest;
}

double findDeepestConcavity(const Mesh& mesh, double positionTolerance) {
  double deepest = 0;
  for (const auto& [edge, uses] : collectEdges(mesh, positionTolerance)) {
    if (uses.size() != 2 || uses[0].forwards == uses[1].forwards) continue;
    const dvec3 n0 = planeNormal(corners(mesh, uses[0].triangle)),
                n1 = planeNormal(corners(mesh, uses[1].triangle));
    const dvec3 edgePoint = mesh.positions[edge.first];
    const double height = glm::dot(dvec3(mesh.positions[uses[1].opposite]) - edgePoint, n0);
    const double scale = glm::length(edgePoint) + glm::length(dvec3(mesh.positions[uses[1].opposite]));
    if (height > 4e-7 * scale)
      deepest = std::max(deepest, std::acos(std::clamp(glm::dot(n0, n1), -1.0, 1.0)));
  }
  return deepest;
}

double findSmallestCorner(const Mesh& mesh) {
  double smallest = 10;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto p = corners(mesh, t);
    for (int k = 0; k < 3; ++k) {
      const dvec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      smallest = std::min(smallest, std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
    }
  }
  return smallest;
}

core::Box computeBounds(const Mesh& mesh) {
  core::Box box;
  for (const vec3& p : mesh.positions) box.add(dvec3(p));
  return box;
}

}  // namespace catoptric::geometry
