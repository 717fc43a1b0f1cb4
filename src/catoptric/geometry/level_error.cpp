// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/level_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "catoptric/geometry/nearest_point.h"

namespace catoptric::geometry {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::uint32_t findRoot(std::vector<std::uint32_t>& parents, std::uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

std::vector<std::uint32_t> findPieces(std::size_t vertices, std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> parents(vertices);
  std::iota(parents.begin(), parents.end(), 0u);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k)
      parents[findRoot(parents, indices[i + k])] = findRoot(parents, indices[i]);
  for (std::uint32_t v = 0; v < vertices; ++v) parents[v] = findRoot(parents, v);
  return parents;
}

/// By vertex: the least that texture coordinates change per unit of length, of the triangles around it, as a
/// square of the same area would.
std::vector<float> findRates(std::span<const vec2> uv, std::span<const vec3> positions,
                             std::span<const std::uint32_t> indices) {
  std::vector<float> rates;
  if (uv.empty()) return rates;
  rates.assign(positions.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
    const float area = glm::length(glm::cross(positions[b] - positions[a], positions[c] - positions[a]));
    const vec2 e1 = uv[b] - uv[a], e2 = uv[c] - uv[a];
    const float rate = area > 0 ? std::sqrt(std::abs(e1.x * e2.y - e1.y * e2.x) / area) : 0.0f;
    for (const std::uint32_t v : {a, b, c}) rates[v] = std::min(rates[v], rate);
  }
  return rates;
}

/// Of two directions of any length.
double angleBetween(const vec3& a, const vec3& b) {
  const dvec3 x(a), y(b);
  return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y));
}

}  // namespace

LevelJudge::LevelJudge(const SimplifiableMesh& mesh, const std::vector<std::uint32_t>& joined)
    : mesh_(mesh),
      used_(joined),
      pieceOf_(findPieces(mesh.positions.size(), joined)),
      uv0PerUnit_(findRates(mesh.uv0, mesh.positions, joined)),
      uv1PerUnit_(findRates(mesh.uv1, mesh.positions, joined)),
      hierarchy_(makeHierarchy(joined)) {
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
}

TriangleHierarchy LevelJudge::makeHierarchy(std::span<const std::uint32_t> indices) const {
  std::vector<HierarchyTriangle> triangles(indices.size() / 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t* v = &indices[3 * std::size_t(t)];
    triangles[t] = {
        mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]], t, pieceOf_[v[0]], 0};
  }
  return TriangleHierarchy(triangles);
}

void LevelJudge::measure(SimplifiedLevel& level) const {
  measureFromMesh(level);
  if (level.distance < kInfinite) measureFromLevel(level);
}

void LevelJudge::compareVertex(std::uint32_t vertex, const NearestPoint& nearest,
                               std::span<const std::uint32_t> indices, SimplifiedLevel& level) const {
  const std::uint32_t* corner = &indices[3 * std::size_t(nearest.triangle)];
  const auto mix = [&](const auto& values) {
    return values[corner[0]] * float(1 - nearest.u - nearest.v) + values[corner[1]] * float(nearest.u) +
           values[corner[2]] * float(nearest.v);
  };
  const auto addSlip = [&](std::span<const vec2> uv, const std::vector<float>& perUnit) {
    if (uv.empty()) return;
    const double change = glm::length(mix(uv) - uv[vertex]);
    constexpr double kRounding = 1e-6;
    if (change > kRounding) level.distance = std::max(level.distance, change / double(perUnit[vertex]));
  };
  level.distance = std::max(level.distance, nearest.distance);
  level.normalRadians =
      std::max(level.normalRadians, angleBetween(mix(mesh_.normals), mesh_.normals[vertex]));
  addSlip(mesh_.uv0, uv0PerUnit_);
  addSlip(mesh_.uv1, uv1PerUnit_);
  if (!mesh_.tangents.empty())
    level.normalRadians =
        std::max(level.normalRadians, angleBetween(vec3(mix(mesh_.tangents)), vec3(mesh_.tangents[vertex])));
  if (!mesh_.colors.empty())
    level.color = std::max(level.color, double(glm::length(mix(mesh_.colors) - mesh_.colors[vertex])));
}

void LevelJudge::measureFromMesh(SimplifiedLevel& level) const {
  const TriangleHierarchy hierarchy = makeHierarchy(level.indices);
  // What the level keeps is where it was; at a seam the nearest point could be one of the other side.
  std::vector<std::uint8_t> isKept(mesh_.positions.size(), 0);
  for (const std::uint32_t v : level.indices) isKept[v] = 1;
  double most = kInfinite;
  dvec3 last(0);
  std::uint32_t lastPiece = 0xffffffffu;
  for (const std::uint32_t v : used_) {
    if (isKept[v] != 0) continue;
    const dvec3 point(mesh_.positions[v]);
    // The predecessor's nearest point is no farther than the way there and on.
    constexpr double kSlack = 1.0001;
    const bool isNeighbour = pieceOf_[v] == lastPiece;
    const double bound = isNeighbour ? kSlack * (most + glm::length(point - last)) + 1e-30 : kInfinite;
    const auto nearest = findNearestPoint(hierarchy, point, bound, pieceOf_[v]);
    if (!nearest) {
      level.distance = kInfinite;
      return;
    }
    compareVertex(v, *nearest, level.indices, level);
    most = nearest->distance, last = point, lastPiece = pieceOf_[v];
  }
}

void LevelJudge::measureFromLevel(SimplifiedLevel& level) const {
  for (std::size_t i = 0; i + 2 < level.indices.size(); i += 3) {
    const std::uint32_t* v = &level.indices[i];
    // A corner is on both.
    const auto look = [&](const dvec3& point, const vec3& corner) {
      const double most = 1.0001 * glm::length(point - dvec3(corner)) + 1e-30;
      const auto nearest = findNearestPoint(hierarchy_, point, most, pieceOf_[v[0]]);
      level.distance = std::max(level.distance, nearest ? nearest->distance : kInfinite);
    };
    const std::array<vec3, 3> p{mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    look((dvec3(p[0]) + dvec3(p[1]) + dvec3(p[2])) / 3.0, p[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;  // an inner edge: for the triangle in which it goes upwards
      if (v[k] < v[next]) look((dvec3(p[k]) + dvec3(p[next])) / 2.0, p[k]);
    }
  }
}

}  // namespace catoptric::geometry
