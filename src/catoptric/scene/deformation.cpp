// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/deformation.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::scene {
namespace {

constexpr std::size_t kGrain = 2048;

/// Step 1 for vertices begin..end.
void addTargets(const Deformation& source, std::span<const float> weights, std::size_t begin, std::size_t end,
                DeformedVertices& out) {
  for (std::size_t t = 0; t < std::min(weights.size(), source.targets.size()); ++t) {
    const float weight = weights[t];
    const Deformation::Target& target = source.targets[t];
    if (weight == 0.0f) continue;
    if (!target.positions.empty())
      for (std::size_t i = begin; i < end; ++i) out.positions[i] += weight * target.positions[i];
    if (!target.normals.empty() && !source.normals.empty())
      for (std::size_t i = begin; i < end; ++i) out.normals[i] += weight * target.normals[i];
    if (!target.tangents.empty() && !source.tangents.empty())
      for (std::size_t i = begin; i < end; ++i) out.tangents[i] += vec4(weight * target.tangents[i], 0.0f);
  }
}

dmat4 blendJoints(const Deformation& source, std::span<const dmat4> worldFromVertex, std::size_t vertex) {
  dmat4 sum(0.0);
  for (std::size_t k = vertex * source.influences; k < (vertex + 1) * source.influences; ++k)
    if (source.jointWeights[k] != 0.0f)
      sum += double(source.jointWeights[k]) * worldFromVertex[source.joints[k]];
  return sum;
}

/// Step 2 for one vertex.
void moveVertex(const dmat4& matrix, std::size_t i, bool hasNormals, DeformedVertices& out) {
  out.positions[i] = vec3(dvec3(matrix * dvec4(dvec3(out.positions[i]), 1.0)));
  const dmat3 m(matrix);
  const double sign = glm::determinant(m) < 0 ? -1 : 1;
  if (hasNormals) {
    const dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const dvec3 normal = sign * (cofactors * dvec3(out.normals[i]));
    const double length = glm::length(normal);
    out.normals[i] = length > 0 ? vec3(normal / length) : vec3(0);
  }
  if (!out.tangents.empty())
    out.tangents[i] = vec4(vec3(m * dvec3(vec3(out.tangents[i]))), float(sign) * out.tangents[i].w);
}

/// Step 3: unit length, or `fallback` where there is no direction.
vec3 toUnit(const vec3& v, const vec3& fallback) {
  const double length = glm::length(dvec3(v));
  return length > 1e-20 && std::isfinite(length) ? vec3(dvec3(v) / length) : fallback;
}

/// Step 3 without normals: every three vertices are a triangle.
void makeFlatNormals(std::size_t begin, std::size_t end, DeformedVertices& out) {
  for (std::size_t i = 3 * begin; i < 3 * end; i += 3) {
    const dvec3 a(out.positions[i]), b(out.positions[i + 1]), c(out.positions[i + 2]);
    const dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (length > 0 && std::isfinite(length))
      out.normals[i] = out.normals[i + 1] = out.normals[i + 2] = vec3(normal / length);
  }
}

}  // namespace

void deform(const Deformation& source, std::span<const float> weights, std::span<const dmat4> worldFromVertex,
            DeformedVertices& out) {
  const std::size_t count = source.positions.size();
  const bool hasNormals = !source.normals.empty();
  out.positions.resize(count);
  out.normals.resize(count, vec3(0, 1, 0));
  out.tangents.resize(source.tangents.size());
  core::parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out.positions[i] = source.positions[i];
    if (hasNormals)
      std::copy_n(source.normals.begin() + std::ptrdiff_t(begin), end - begin,
                  out.normals.begin() + std::ptrdiff_t(begin));
    if (!source.tangents.empty())
      std::copy_n(source.tangents.begin() + std::ptrdiff_t(begin), end - begin,
                  out.tangents.begin() + std::ptrdiff_t(begin));
    addTargets(source, weights, begin, end, out);
    if (source.influences > 0)
      for (std::size_t i = begin; i < end; ++i)
        moveVertex(blendJoints(source, worldFromVertex, i), i, hasNormals, out);
    if (hasNormals)
      for (std::size_t i = begin; i < end; ++i) out.normals[i] = toUnit(out.normals[i], source.normals[i]);
    for (std::size_t i = begin; i < std::min(end, out.tangents.size()); ++i)
      out.tangents[i] = vec4(toUnit(vec3(out.tangents[i]), vec3(1, 0, 0)), out.tangents[i].w);
  });
  if (!hasNormals)
    core::parallelFor(count / 3, kGrain,
                      [&](std::size_t begin, std::size_t end) { makeFlatNormals(begin, end, out); });
}

}  // namespace catoptric::scene
