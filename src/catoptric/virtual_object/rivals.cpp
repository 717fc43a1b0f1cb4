// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/rivals.h"

#include <algorithm>
#include <bit>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/lane_shader.h"

namespace catoptric::virtual_object {
namespace {

namespace lanes = core::lanes;
using core::kLanes;

/// Eight pixels and two triangles each.
struct Settle {
  const LaneImages& images;
  const SceneTriangles& triangles;
  LaneShader& shader;

  struct Rays {
    lanes::Vec3 origin, direction;
    lanes::Float begin;
  };

  CATOPTRIC_INLINE Rays loadRays(const Rival* const (&of)[kLanes]) const {
    const vec4* places[kLanes];
    lanes::Float x, y;
    for (int i = 0; i < kLanes; ++i) {
      const std::uint32_t at = of[i]->pixel;
      places[i] = &images.positions[at];
      x.v[i] = images.radiances[at].w, y.v[i] = images.weights[at].w;
    }
    const lanes::Vec3 origin(lanes::loadRows(places));
    return {origin, shader.directionFromOctahedral({x, y}), shader.findRayBegin(origin)};
  }

  CATOPTRIC_INLINE LaneShader::RayHit meet(const Rays& rays, const std::uint32_t (&numbers)[kLanes]) const {
    core::EightInts corners[3];
    for (int i = 0; i < kLanes; ++i) {
      const uvec4& triangle = triangles.triangleTexels()[numbers[i] - 1u];
      for (int k = 0; k < 3; ++k) corners[k][i] = std::int32_t(triangle[k]);
    }
    using lanes::Vec3;
    const Vec3 a = Vec3(shader.readVertex(corners[0], 0)) - rays.origin,
               b = Vec3(shader.readVertex(corners[1], 0)) - rays.origin,
               c = Vec3(shader.readVertex(corners[2], 0)) - rays.origin;
    return shader.meetTriangle(rays.direction, rays.begin, a, b, c, cross(b - a, c - a));
  }

  static CATOPTRIC_INLINE void run(const Settle& self, const std::vector<Rival>& rivals,
                                   NumberImage& numbers) {
    for (std::size_t first = 0; first < rivals.size(); first += std::size_t(kLanes)) {
      const std::size_t count = std::min(rivals.size() - first, std::size_t(kLanes));
      const Rival* of[kLanes];
      std::uint32_t seen[kLanes], second[kLanes];
      lanes::Mask isEmpty;
      for (std::size_t i = 0; i < std::size_t(kLanes); ++i) {
        of[i] = &rivals[first + std::min(i, count - 1)];
        const std::uint32_t number = numbers.hits[of[i]->pixel].x;
        isEmpty.v[i] = number == 0 ? -1 : 0;
        second[i] = of[i]->number, seen[i] = number == 0 ? second[i] : number;
      }
      const Rays rays = self.loadRays(of);
      const LaneShader::RayHit one = self.meet(rays, seen), other = self.meet(rays, second);
      const unsigned isOther = core::toBits((other.isHit && (isEmpty || other.t < one.t)).v);
      for (std::size_t i = 0; i < count; ++i) {
        if ((isOther >> i & 1u) == 0) continue;
        bool isNearest = true;  // of those for the same pixel
        for (std::size_t k = 0; k < i; ++k)
          isNearest = isNearest && (of[k]->pixel != of[i]->pixel || (isOther >> k & 1u) == 0 ||
                                    other.t.v[i] < other.t.v[k]);
        if (!isNearest) continue;
        numbers.hits[of[i]->pixel] = {second[i], std::bit_cast<std::uint32_t>(of[i]->length)};
        if (!numbers.depths.empty()) numbers.depths[of[i]->pixel] = of[i]->depth;
      }
    }
  }
};

}  // namespace

void settleRivals(const LaneImages& images, const SceneTriangles& triangles, NumberImage& numbers) {
  core::parallelFor(numbers.rivals.size(), 1, [&](std::size_t begin, std::size_t end) {
    LaneShader shader;
    shader.u_vertices = triangles.vertexTexels().data();
    const Settle settle{images, triangles, shader};
    for (std::size_t i = begin; i < end; ++i)
      core::runOnWidestVectors<Settle>(settle, numbers.rivals[i], numbers);
  });
}

}  // namespace catoptric::virtual_object
