// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/part_pixels.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

constexpr float kMostMissPx = 1.0f;
constexpr std::size_t kRowsPerTask = 8;

/// What a step of one pixel moves the point at a distance t along the ray by; nothing beyond the mirror's
/// edge.
float findFootprint(const RayImages& rays, std::size_t pixel, std::size_t neighbour, float t) {
  if (rays.words[neighbour].y != rays.words[pixel].y) return 0.0f;
  const vec4 step = rays.origins[neighbour] - rays.origins[pixel] +
                    t * (rays.directions[neighbour] - rays.directions[pixel]);
  return glm::length(vec3(step));
}

/// How far beside the triangle the ray passes through its plane, world units; negative inside. Infinite where
/// it never does. `t`: at which distance.
float findMiss(const vec3 (&corners)[3], const vec3& origin, const vec3& direction, float& t) {
  const vec3 a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
  const vec3 n = glm::cross(b - a, c - a);
  const float across = glm::dot(direction, n), area = glm::length(n);
  t = across != 0.0f ? glm::dot(a, n) / across : -1.0f;
  if (!(t > 0.0f)) return std::numeric_limits<float>::infinity();
  const vec3 p = t * direction;
  const vec3 from[3] = {a, b, c};
  float miss = -std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    const vec3 edge = from[(k + 1) % 3] - from[k];
    const float side = glm::dot(glm::cross(edge, p - from[k]), n);
    miss = std::max(miss, -side / (area * glm::length(edge)));
  }
  return miss;
}

}  // namespace

void confirmPixels(const scene::WorldGeometry& world, const RayImages& rays, const PartPicture& picture,
                   MirrorPixels& pixels) {
  const gl::Scissor& bounds = picture.bounds;
  const auto isRight = [&](std::size_t pixel, std::size_t right, std::size_t below, std::uint32_t triangle) {
    vec3 corners[3];
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = world.positions[world.indices[3 * std::size_t(triangle) + k]];
    float t;
    const float miss = findMiss(corners, vec3(rays.origins[pixel]), vec3(rays.directions[pixel]), t);
    if (miss <= 0.0f) return true;
    if (!std::isfinite(miss)) return false;
    return miss <=
           kMostMissPx * std::min(findFootprint(rays, pixel, right, t), findFootprint(rays, pixel, below, t));
  };
  core::parallelFor(std::size_t(bounds.height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::size_t y = std::size_t(bounds.y) + row, width = std::size_t(rays.widthPx);
      const std::size_t first = row * std::size_t(bounds.width);
      const std::size_t to = (y - std::size_t(pixels.bounds.y)) * std::size_t(pixels.bounds.width) +
                             std::size_t(bounds.x - pixels.bounds.x);
      for (std::size_t column = 0; column < std::size_t(bounds.width); ++column) {
        const uvec2 hit = picture.image.hits[first + column];
        uvec2& best = pixels.confirmed.hits[to + column];
        if (hit.x == 0 || pixels.partNumbers[to + column].x != picture.part) continue;
        // Lengths are positive: their bits have their order.
        if (best.x != 0 && best.y <= hit.y) continue;
        const std::size_t x = std::size_t(bounds.x) + column, pixel = y * width + x;
        if (rays.words[pixel].y != pixels.word) continue;
        const std::size_t right = x + 1 < width ? pixel + 1 : pixel - 1,
                          below = y > 0 ? pixel - width : pixel + width;
        if (!isRight(pixel, right, below, hit.x - 1)) continue;
        best = hit;
        pixels.confirmed.depths[to + column] = picture.image.depths[first + column];
      }
    }
  });
}

}  // namespace catoptric::virtual_object
