// SPDX-License-Identifier: Apache-2.0
// Where is a vertex drawn so that a rasterizer shows its reflection?
//
// In: the maps and octrees of one trace at the eight locations around the eye; vertices, eye (world, metres).
// Out: for each vertex a point on the ray from the eye to the mirror, as far away as the path is long.
//   1. At each location the leaf of the octree that holds the vertex gives rays that pass near; from the
//      nearest of them the map is searched for the ray that passes through it (find_ray.cpp).
//   2. The eight points where these rays leave the first mirror are interpolated with the weights of the eye
//      in its cell, and so are the eight lengths from there to the vertex.
//   3. The vertex is drawn on the ray from the eye through the interpolated point, at the length of the path.
//
// Step 1 depends on the cell and the vertex only: for static vertices it is done once a cell (CornerPoints).
//
// Departures from 2004: vertices that are not reflected but belong to a triangle that is are placed by
// continuing the map past its edge; the paper drops such triangles, which leaves gaps at the rim. The length
// of the path is interpolated, for traces over several mirrors. Failures: the interpolated point is off by
// the sag of the mirror points between the locations, which grows with the square of the cell. Cost: the
// rates in the README. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/morphing.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::reflection_morphing {

std::array<float, 8> weighTrace(const CellTrace& trace, const std::array<float, 8>& weights) {
  constexpr float kLeast = 0.25f;
  std::array<float, 8> result{};
  float sum = 0;
  for (std::size_t k = 0; k < 8; ++k)
    if (trace[k] != nullptr) sum += result[k] = weights[k];
  for (float& weight : result) weight = sum < kLeast ? 0.0f : weight / sum;
  return result;
}

void morphVertices(const vec3& eye, const std::array<float, 8>& weights, const CornerPoints& corners,
                   std::span<vec3> virtualPositions, std::span<vec3> mirrorPoints) {
  constexpr std::size_t kGrain = 4096;
  assert(virtualPositions.size() == corners.points.size() && mirrorPoints.size() == corners.points.size());
  core::parallelFor(corners.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (corners.kinds[i] == raster::VertexKind::None) continue;
      const std::array<vec4, 8>& p = corners.points[i];
      vec4 sum = weights[0] * p[0];
      for (std::size_t k = 1; k < 8; ++k) sum += weights[k] * p[k];
      const vec3 mirrorPoint(sum), ray = mirrorPoint - eye;
      const float length = std::sqrt(glm::dot(ray, ray));
      virtualPositions[i] = eye + ray * ((length + sum.w) / length);
      mirrorPoints[i] = mirrorPoint;
    }
  });
}

}  // namespace catoptric::reflection_morphing
