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
// the sag of the mirror points between the locations, which grows with the square of the cell. Cost: step 1
// 1 us a vertex and core, steps 2 and 3 20 ns. Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/morphing.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::reflection_morphing {

using raster::VertexKind;

namespace {

constexpr std::size_t kSideBySide = 64;  // searches; their texels fit the nearest cache

/// Step 1 for up to kSideBySide vertices at one location.
void lookUp(const SampledTrace& trace, std::span<const vec3> points,
            std::array<FoundRay, kSideBySide>& found) {
  const RayMap& map = trace.map;
  std::array<std::span<const std::uint32_t>, kSideBySide> leaves;
  std::array<RaySearch, kSideBySide> searches;
  std::array<std::uint8_t, kSideBySide> active;
  for (std::size_t i = 0; i < points.size(); ++i) {
    leaves[i] = trace.octree.findLeaf(points[i]);
    __builtin_prefetch(leaves[i].data());
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const std::uint32_t ray : leaves[i]) __builtin_prefetch(&map.texels[ray]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    searches[i].start(map, points[i], findNearestRay(map, leaves[i], points[i]));
    active[i] = std::uint8_t(i);
  }
  for (std::size_t count = points.size(); count > 0;) {
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      RaySearch& search = searches[active[k]];
      if (search.advance(map))
        found[active[k]] = search.found();
      else
        active[left++] = active[k];
    }
    count = left;
  }
}

}  // namespace

void lookUpCorners(const CellTrace& trace, std::span<const vec3> scenePoints, CornerPoints& corners) {
  corners.points.resize(scenePoints.size());
  corners.kinds.assign(scenePoints.size(), VertexKind::None);
  core::parallelFor(scenePoints.size(), 512, [&](std::size_t begin, std::size_t end) {
    std::array<FoundRay, kSideBySide> found;
    for (std::size_t k = 0; k < 8; ++k)  // a location at a time: its map stays in the cache
      for (std::size_t first = begin; first < end; first += kSideBySide) {
        const std::size_t count = std::min(kSideBySide, end - first);
        if (trace[k] != nullptr) lookUp(*trace[k], scenePoints.subspan(first, count), found);
        for (std::size_t i = 0; i < count; ++i) {
          std::array<vec4, 8>& points = corners.points[first + i];
          points[k] = trace[k] ? vec4(found[i].mirrorPoint, found[i].rest) : vec4(0);
          if (trace[k] == nullptr) continue;
          VertexKind& kind = corners.kinds[first + i];
          if (found[i].isInside)
            kind = VertexKind::Reflected;
          else if (kind == VertexKind::None)
            kind = VertexKind::DoublyVirtual;
        }
      }
  });
}

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
