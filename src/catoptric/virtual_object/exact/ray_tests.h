// SPDX-License-Identifier: Apache-2.0
// Step 3 of solver `exact` where GL is software: rays against triangles by the processor, eight rays at a
// time.
//
// In:  the rays of a tile of mirror pixels and opaque triangles that they may meet (tile_hits.h).
// Out: the nearest triangle that each ray meets, and how far away.
// The signs and the distance are those of meetTriangle() in shaders/lib/ray_triangle.glsl: to the bit.
// Source: our own; the fragment's test after Hou 2006 and Liu 2011.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/core/seen.h"

namespace catoptric::virtual_object {

/// Rays side by side, filled up to whole lanes with rays that meet nothing.
class RayLanes {
 public:
  /// `direction.w`: the distance at which the ray begins to hit. No ray has hit anything yet.
  void assign(std::span<const vec4> origins, std::span<const vec4> directions);

  /// Infinity where nothing was met.
  [[nodiscard]] float distance(std::size_t ray) const { return distances_[ray]; }
  /// Test::triangle of what was met, or core::kNoId.
  [[nodiscard]] std::uint32_t triangle(std::size_t ray) const { return triangles_[ray]; }

  /// Keeps the triangle where it is met before everything that was tested earlier. `isOwn`: of the mirror
  /// itself, so rays may start on it, and do not meet it then.
  struct Test {
    vec3 a{0}, b{0}, c{0};
    vec3 normal{0};              ///< cross(b - a, c - a)
    std::uint32_t triangle = 0;  ///< as the caller counts
    bool isSingleSided = false, isOwn = false;
  };
  /// Returns the largest distance of all rays: infinity until each has met something.
  float meet(std::span<const Test> tests);

  /// Three coordinates of origins, three of directions, and where hits begin.
  enum : std::uint8_t { kOrigin = 0, kDirection = 3, kBegin = 6, kNumbers = 7 };

 private:
  std::size_t count_ = 0, padded_ = 0;
  std::vector<float> numbers_[kNumbers];
  std::vector<float> distances_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace catoptric::virtual_object
