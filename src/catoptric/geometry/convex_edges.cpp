// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/convex_edges.h"

#include <array>
#include <map>
#include <utility>

namespace catoptric::geometry {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The triangle to the left of each directed edge.
std::map<Edge, std::uint32_t> collectLeftTriangles(const Mesh& mesh) {
  std::map<Edge, std::uint32_t> left;
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      left[{mesh.indices[3 * t + k], mesh.indices[3 * t + (k + 1) % 3]}] = t;
  return left;
}

std::uint32_t cornerOpposite(const Mesh& mesh, std::uint32_t triangle, const Edge& edge) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh.indices[3 * triangle + k];
    if (v != edge.first && v != edge.second) return v;
  }
  return edge.first;
}

dvec3 crossOf(const dvec3& a, const dvec3& b, const dvec3& c) {
  return glm::cross(b - a, c - a);
}

/// Does the surface bend towards its front along edge a -> b, with c left and d right of it, and can it be
/// flipped?
bool shouldFlip(const Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const dvec3 pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c], pd = mesh.positions[d];
  const dvec3 left = crossOf(pa, pb, pc);
  if (!(glm::length(left) > 0)) return false;
  const double height = glm::dot(pd - pa, glm::normalize(left));
  if (height <= 1e-7 * glm::distance(pc, pd)) return false;
  // The two new triangles must face the same way as the old: the quad must be convex seen from the front.
  return glm::dot(crossOf(pc, pd, pb), left) > 0 && glm::dot(crossOf(pd, pc, pa), left) > 0;
}

}  // namespace

Mesh withConvexEdges(Mesh mesh) {
  constexpr int kMaxSweeps = 64;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    const std::map<Edge, std::uint32_t> left = collectLeftTriangles(mesh);
    std::vector<bool> isTouched(mesh.triangleCount(), false);  // one flip a triangle and sweep
    bool isChanged = false;
    for (const auto& [edge, t] : left) {
      const auto other = left.find({edge.second, edge.first});
      if (edge.first > edge.second || other == left.end()) continue;
      const std::uint32_t u = other->second;
      if (isTouched[t] || isTouched[u]) continue;
      const std::uint32_t c = cornerOpposite(mesh, t, edge), d = cornerOpposite(mesh, u, edge);
      if (!shouldFlip(mesh, edge.first, edge.second, c, d)) continue;
      const std::array<std::uint32_t, 6> flippedPair = {edge.first, d, c, edge.second, c, d};
      for (std::uint32_t k = 0; k < 3; ++k) {
        mesh.indices[3 * t + k] = flippedPair[k];
        mesh.indices[3 * u + k] = flippedPair[3 + k];
      }
      isTouched[t] = isTouched[u] = isChanged = true;
    }
    if (!isChanged) break;
  }
  return mesh;
}

}  // namespace catoptric::geometry
