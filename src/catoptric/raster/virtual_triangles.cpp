// SPDX-License-Identifier: Apache-2.0
// A mirror turns every triangle's orientation round, as seen from the eye against as seen from the mirror. A
// triangle that reaches around the reflector's shadow does not: its corners come to lie all around the rim,
// and drawn it would cover the mirror from rim to rim with what belongs into a ring thinner than a pixel.
// Orientation finds it.
#include "catoptric/raster/virtual_triangles.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::raster {
namespace {

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr float kEdgeOn = 0.02f;  // sine below which a face says nothing about its orientation

/// +1 where all three points lie in front of their triangle's plane, -1 behind, 0 mixed or nearly in it.
int findSide(const vec3& normal, const vec3 offsets[3]) {
  const float scale = kEdgeOn * std::sqrt(glm::dot(normal, normal));
  int side = 0;
  for (int k = 0; k < 3; ++k) {
    const float height = glm::dot(normal, offsets[k]);
    const float least = scale * std::sqrt(glm::dot(offsets[k], offsets[k]));
    const int here = height > least ? 1 : height < -least ? -1 : 0;
    if (here == 0 || (k > 0 && here != side)) return 0;
    side = here;
  }
  return side;
}

/// Real corners q, virtual ones w, reflection points j; eye.
bool isInsideOut(const vec3 q[3], const vec3 w[3], const vec3 j[3], const vec3& eye) {
  const vec3 normal = glm::cross(q[1] - q[0], q[2] - q[0]);
  const vec3 towardsMirror[3] = {j[0] - q[0], j[1] - q[1], j[2] - q[2]};
  const int real = findSide(normal, towardsMirror);
  if (real == 0) return false;
  const vec3 towardsEye = eye - w[0];
  const float image = glm::dot(glm::cross(w[1] - w[0], w[2] - w[0]), towardsEye);
  return image * float(real) > 0.0f;
}

/// What tells whether a triangle is kept, by vertex.
struct Judge {
  std::span<const vec3> scenePoints, virtualPositions, reflectionPoints;
  std::span<const VertexKind> kinds;
  vec3 eye;
  float longestChord;

  [[nodiscard]] bool keeps(const std::uint32_t v[3]) const {
    const VertexKind a = kinds[v[0]], b = kinds[v[1]], c = kinds[v[2]];
    if (a == VertexKind::None || b == VertexKind::None || c == VertexKind::None) return false;
    if (a != VertexKind::Reflected && b != VertexKind::Reflected && c != VertexKind::Reflected) return false;
    const vec3 q[3] = {scenePoints[v[0]], scenePoints[v[1]], scenePoints[v[2]]};
    const vec3 w[3] = {virtualPositions[v[0]], virtualPositions[v[1]], virtualPositions[v[2]]};
    const vec3 j[3] = {reflectionPoints[v[0]], reflectionPoints[v[1]], reflectionPoints[v[2]]};
    const bool isMixed = a != b || b != c;
    if (isMixed && std::max({glm::distance(j[0], j[1]), glm::distance(j[1], j[2]),
                             glm::distance(j[2], j[0])}) > longestChord)
      return false;
    return !isInsideOut(q, w, j, eye);
  }
};

}  // namespace

void dropVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, std::span<std::uint8_t> isKept,
                          std::span<const vec3> scenePoints, float longestChord) {
  if (scenePoints.empty()) scenePoints = objects.positions;
  assert(scenePoints.size() == objects.positions.size());
  assert(virtualPositions.size() == objects.positions.size() && kinds.size() == objects.positions.size());
  assert(reflectionPoints.size() == objects.positions.size());
  const Judge judge{scenePoints, virtualPositions, reflectionPoints, kinds, vec3(eye), longestChord};
  assert(isKept.size() == objects.indices.size() / 3);
  core::parallelFor(isKept.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (isKept[t] && !judge.keeps(&objects.indices[3 * t])) isKept[t] = 0;
  });
}

void markVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                          std::span<const vec3> scenePoints, float longestChord) {
  out.isKept.assign(objects.indices.size() / 3, 1);
  dropVirtualTriangles(objects, eye, virtualPositions, kinds, reflectionPoints, out.isKept, scenePoints,
                       longestChord);
}

void selectVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                            std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                            std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                            std::span<const vec3> scenePoints) {
  markVirtualTriangles(objects, eye, virtualPositions, kinds, reflectionPoints, out, scenePoints);
  gatherVirtualTriangles(objects, objects.indices, {}, out);
}

void gatherVirtualTriangles(const TessellatedObjects& objects, std::span<const std::uint32_t> indices,
                            std::span<const std::uint8_t> isWanted, VirtualTriangles& out) {
  assert(indices.size() == objects.indices.size());
  out.indices.clear();
  out.parts.clear();
  for (const TessellatedPart& part : objects.parts) {
    if (!isWanted.empty() && !isWanted[part.part]) continue;
    TessellatedPart run = part;
    run.firstIndex = std::uint32_t(out.indices.size());
    for (std::size_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
      if (out.isKept[i / 3]) out.indices.insert(out.indices.end(), &indices[i], &indices[i] + 3);
    run.indexCount = std::uint32_t(out.indices.size()) - run.firstIndex;
    out.parts.push_back(run);
  }
}

}  // namespace catoptric::raster
