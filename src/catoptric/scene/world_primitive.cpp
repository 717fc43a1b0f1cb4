// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/world_primitive.h"

#include <cmath>
#include <utility>

namespace catoptric::scene {
namespace {

constexpr float kLargestCoordinate = 1e15f;  // squares stay finite in float

bool isUsable(const vec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;  // false for NaN
}

/// Columns a, b, c -> the matrix that carries normals, up to a positive factor; works for singular ones too.
dmat3 computeNormalMatrix(const dmat3& m) {
  const dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

/// Normals of vertices that have none worth the name: the mean of their triangles' normals, by area.
void repairNormals(WorldPrimitive& primitive, const std::vector<std::uint32_t>& broken) {
  if (broken.empty()) return;
  std::vector<dvec3> sums(primitive.positions.size(), dvec3(0));
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const dvec3 a(primitive.positions[primitive.indices[i]]),
        b(primitive.positions[primitive.indices[i + 1]]), c(primitive.positions[primitive.indices[i + 2]]);
    const dvec3 n = glm::cross(b - a, c - a);
    for (int k = 0; k < 3; ++k) sums[primitive.indices[i + k]] += n;
  }
  for (const std::uint32_t v : broken) {
    const double length = glm::length(sums[v]);
    primitive.normals[v] = length > 0 ? vec3(sums[v] / length) : vec3(0, 1, 0);
  }
}

/// Vertices that no kept triangle uses may be anywhere, infinity included: they must not stretch any measure.
void parkUnusedVertices(WorldPrimitive& primitive) {
  if (primitive.indices.empty()) return;
  std::vector<bool> used(primitive.positions.size(), false);
  for (const std::uint32_t v : primitive.indices) used[v] = true;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) primitive.positions[v] = primitive.positions[primitive.indices[0]];
}

bool isDegenerate(const WorldPrimitive& primitive, std::uint32_t ia, std::uint32_t ib, std::uint32_t ic) {
  const vec3 &a = primitive.positions[ia], &b = primitive.positions[ib], &c = primitive.positions[ic];
  if (!isUsable(a) || !isUsable(b) || !isUsable(c)) return true;
  const dvec3 n = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
  return glm::dot(n, n) == 0;
}

}  // namespace

std::uint64_t transformPrimitive(WorldPrimitive& primitive, const dmat4& worldFromMesh) {
  const MeshPrimitive& source = *primitive.source;
  const dmat3 linear(worldFromMesh), normalMatrix = computeNormalMatrix(linear);
  primitive.handedness = glm::determinant(linear) < 0 ? -1 : 1;
  const std::size_t count = source.positions.size();
  primitive.positions.resize(count);
  primitive.normals.resize(count);
  std::vector<std::uint32_t> broken;
  for (std::size_t v = 0; v < count; ++v) {
    primitive.positions[v] = vec3(dvec3(worldFromMesh * dvec4(dvec3(source.positions[v]), 1.0)));
    const dvec3 n = v < source.normals.size() ? normalMatrix * dvec3(source.normals[v]) : dvec3(0);
    const double length = glm::length(n);
    if (length > 0 && std::isfinite(length))
      primitive.normals[v] = vec3(n / length);
    else
      broken.push_back(static_cast<std::uint32_t>(v));
  }
  std::uint64_t dropped = 0;
  primitive.indices.reserve(source.indices.size());
  for (std::size_t i = 0; i + 2 < source.indices.size(); i += 3) {
    std::uint32_t a = source.indices[i], b = source.indices[i + 1], c = source.indices[i + 2];
    if (primitive.handedness < 0) std::swap(b, c);
    if (isDegenerate(primitive, a, b, c))
      ++dropped;
    else
      primitive.indices.insert(primitive.indices.end(), {a, b, c});
  }
  parkUnusedVertices(primitive);
  repairNormals(primitive, broken);
  return dropped;
}

}  // namespace catoptric::scene
