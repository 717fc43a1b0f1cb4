// SPDX-License-Identifier: Apache-2.0
// Vertices and triangles that no reflected ray comes near, left out (methods.md, section 1). Steps:
//   1. Once for the tessellated objects: the box around all triangles at each vertex, and around those of
//      runs of vertices that stand beside each other.
//   2. For each eye, the mirror's beams (reflected_beams.h). A box that lies on the outer side of a plane of
//      every beam meets no ray: runs first, then, where a run is neither outside of all beams nor wholly
//      within one, each vertex.
// Nothing is lost: no triangle that loses a corner could have been seen. A whole ball reflects all around,
// and hardly anything is left out. Cost: a dozen products for each plane and box, eight boxes side by side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/virtual_object/reflected_beams.h"

namespace catoptric::virtual_object {

/// Eight boxes, by coordinate; of those with nothing in them, halves are negative.
struct alignas(32) BoxLanes {
  static constexpr std::size_t kLanes = 8;
  float centre[3][kLanes] = {}, half[3][kLanes];

  BoxLanes() { std::fill_n(&half[0][0], 3 * kLanes, -1.0f); }
  void set(std::size_t lane, const core::Box& box);
};

/// By run of vertices, a bit for each.
using VertexBits = std::uint16_t;

/// Step 1 for vertices.
class VertexRuns {
 public:
  static constexpr std::size_t kLength = 16;

  explicit VertexRuns(const raster::TessellatedObjects& objects);

  [[nodiscard]] std::size_t runs() const { return (vertices_ + kLength - 1) / kLength; }
  /// By run, and by vertex.
  [[nodiscard]] std::span<const BoxLanes> runBoxes() const { return runBoxes_; }
  [[nodiscard]] std::span<const BoxLanes> vertexBoxes() const { return vertexBoxes_; }

  /// Step 2: a bit for each vertex that may be reflected, or is the corner of a triangle that may be.
  /// `beamsFromWorld`: see moveToWorld(). Reuses the memory of `mayReflect`.
  void findReflected(const ReflectedBeams& beams, const dmat4& beamsFromWorld,
                     std::vector<VertexBits>& mayReflect) const;
  /// Vertices without a bit in `mayReflect`, which may be empty for all ones.
  [[nodiscard]] std::size_t countLeftOut(std::span<const VertexBits> mayReflect) const;

 private:
  std::size_t vertices_;
  std::vector<BoxLanes> runBoxes_, vertexBoxes_;
};

/// Triangles in runs: a whole run that no ray meets need not be looked at.
class TriangleRuns {
 public:
  /// Three indices for each triangle.
  TriangleRuns(std::span<const vec3> positions, std::span<const std::uint32_t> indices);

  /// By triangle: 0 in runs that no beam meets, 1 in the others. How many triangles those have.
  std::size_t mark(const ReflectedBeams& beams, const dmat4& beamsFromWorld,
                   std::vector<std::uint8_t>& mayMeet) const;

 private:
  std::size_t triangles_;
  std::vector<BoxLanes> boxes_;
};

}  // namespace catoptric::virtual_object
