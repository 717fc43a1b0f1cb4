// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/extrusion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/geometry/symmetric_eigen.h"
#include "catoptric/geometry/vertex_weld.h"

namespace catoptric::geometry {
namespace {

constexpr double kMostTilt = 0.02;  // radians, root mean square: normals that leave the plane across the axis
constexpr double kLeastSpread = 1e-6;  // of the normals within that plane: less is a flat mesh
constexpr double kWeld = 1e-5;         // of the mesh's extent
constexpr double kWeldAngle = 1e-2;    // radians

constexpr std::uint32_t kNone = 0xffffffffu;

/// Neighbours of a profile point along the curve.
struct Links {
  std::array<std::uint32_t, 2> to{kNone, kNone};
  /// False when there are two others already.
  bool add(std::uint32_t point) {
    for (std::uint32_t& link : to) {
      if (link == point) return true;
      if (link == kNone) {
        link = point;
        return true;
      }
    }
    return false;
  }
};

/// Step 1.
bool findAxis(const MeshView& mesh, ExtrusionFit& fit) {
  dmat3 covariance(0.0);
  dvec3 mean(0);
  const double count = double(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    covariance += glm::outerProduct(dvec3(mesh.normals[i]), dvec3(mesh.normals[i])) / count;
    mean += dvec3(mesh.positions[i]) / count;
  }
  const Eigen3 gauss = computeEigen(covariance);
  if (!(gauss.values[0] < kMostTilt * kMostTilt) || !(gauss.values[1] > kLeastSpread)) return false;
  fit.origin = mean;
  fit.axis = gauss.vectors[0];
  fit.x = gauss.vectors[2];
  fit.y = glm::cross(fit.axis, fit.x);
  return true;
}

/// Step 2: the profile point of each vertex, numbered from 0.
std::vector<std::uint32_t> weldProfile(const MeshView& mesh, ExtrusionFit& fit) {
  std::vector<vec3> flat, flatNormals;
  double extent = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec2 p = fit.project(dvec3(mesh.positions[i]));
    const dvec3 n(mesh.normals[i]);
    flat.emplace_back(dvec3(p, 0));
    flatNormals.emplace_back(glm::normalize(dvec3(glm::dot(n, fit.x), glm::dot(n, fit.y), 0)));
    extent = std::max(extent, glm::length(p));
  }
  const auto same =
      weldVertices(flat, flatNormals, {.positionTolerance = kWeld * extent, .normalTolerance = kWeldAngle});
  std::vector<std::uint32_t> pointOf(same.size(), kNone);
  std::vector<double> counts;
  for (std::size_t i = 0; i < same.size(); ++i) {
    std::uint32_t& point = pointOf[same[i]];
    if (point == kNone) {
      point = std::uint32_t(fit.points.size());
      fit.points.emplace_back(0);
      fit.normals.emplace_back(0);
      counts.push_back(0);
    }
    pointOf[i] = point;
    fit.points[point] += fit.project(dvec3(mesh.positions[i]));
    fit.normals[point] += dvec2(flatNormals[i]);
    counts[point] += 1;
  }
  for (std::size_t i = 0; i < fit.points.size(); ++i) {
    fit.points[i] /= counts[i];
    fit.normals[i] = glm::normalize(fit.normals[i]);
  }
  return pointOf;
}

/// Step 3: puts points and normals in order; false where they form neither a chain nor a ring.
bool orderProfile(const MeshView& mesh, std::vector<std::uint32_t>& pointOf, ExtrusionFit& fit) {
  std::vector<Links> links(fit.points.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = pointOf[mesh.indices[i + k]], b = pointOf[mesh.indices[i + (k + 1) % 3]];
      if (a != b && !(links[a].add(b) && links[b].add(a))) return false;
    }
  const auto end = std::find_if(links.begin(), links.end(), [](const Links& l) { return l.to[1] == kNone; });
  fit.isClosed = end == links.end();
  std::vector<std::uint32_t> order{fit.isClosed ? 0u : std::uint32_t(end - links.begin())};
  for (std::uint32_t before = kNone; order.size() <= links.size();) {
    const Links& here = links[order.back()];
    const std::uint32_t next = here.to[0] != before ? here.to[0] : here.to[1];
    if (next == kNone || next == order.front()) break;
    before = order.back();
    order.push_back(next);
  }
  if (order.size() != links.size() || order.size() < 3) return false;
  double left = 0;  // of the normals, seen along the order
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const dvec2 along = fit.points[order[i + 1]] - fit.points[order[i]], n = fit.normals[order[i]];
    left += along.x * n.y - along.y * n.x;
  }
  if (left < 0) std::reverse(order.begin(), order.end());
  std::vector<dvec2> points, normals;
  std::vector<std::uint32_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    points.push_back(fit.points[order[i]]);
    normals.push_back(fit.normals[order[i]]);
    place[order[i]] = std::uint32_t(i);
  }
  for (std::uint32_t& point : pointOf) point = place[point];
  fit.points = std::move(points);
  fit.normals = std::move(normals);
  return true;
}

}  // namespace

std::optional<ExtrusionFit> fitExtrusion(const MeshView& mesh) {
  ExtrusionFit fit;
  if (mesh.positions.size() < 6 || !findAxis(mesh, fit)) return std::nullopt;
  std::vector<std::uint32_t> pointOf = weldProfile(mesh, fit);
  if (!orderProfile(mesh, pointOf, fit)) return std::nullopt;
  // 4
  fit.low = 1e300, fit.high = -1e300;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p(mesh.positions[i]);
    const double along = glm::dot(fit.axis, p - fit.origin);
    fit.low = std::min(fit.low, along);
    fit.high = std::max(fit.high, along);
    const dvec2 off = fit.project(p) - fit.points[pointOf[i]], n2 = fit.normals[pointOf[i]];
    fit.deviation.distance = std::max(fit.deviation.distance, glm::length(off));
    const dvec3 n = n2.x * fit.x + n2.y * fit.y, vertex(mesh.normals[i]);
    fit.deviation.angleRadians = std::max(
        fit.deviation.angleRadians, std::atan2(glm::length(glm::cross(n, vertex)), glm::dot(n, vertex)));
  }
  return fit;
}

}  // namespace catoptric::geometry
