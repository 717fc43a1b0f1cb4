// SPDX-License-Identifier: Apache-2.0
// The triangles of one part of the world, or of a coarser level of it, cut for one mirror: step 4 of
// tessellation.cpp.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/raster/reflector_distance.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::raster {

/// The pieces of one part; indices are local.
struct PartPieces {
  std::vector<vec3> positions, normals;
  std::vector<vec4> tangents;
  std::vector<vec2> uv0, uv1;
  std::vector<vec4> colors;
  std::vector<std::uint32_t> indices, sources;

  void reserve(std::size_t vertices) {
    positions.reserve(vertices), normals.reserve(vertices), tangents.reserve(vertices);
    uv0.reserve(vertices), uv1.reserve(vertices), colors.reserve(vertices);
  }
};

/// What is cut, and how finely.
struct CutOrder {
  const scene::Part& part;
  std::span<const std::uint32_t>
      corners;                      ///< vertices of the world, three for each triangle, all of the part
  std::uint32_t firstTriangle = 0;  ///< number of the first one; the others follow
  const ReflectorDistance& distance;
  const scene::Reflector* mirror = nullptr;  ///< triangles that turn their back to all of it are left out
  float k = 0, floor = 1;                    ///< edges longer than k (d + floor) are split
  /// In place of k, if it is larger, for edges on both sides of which one plane goes on: between two
  /// triangles in one plane, and those that cutting makes.
  float inPlaneK = 0;
  std::size_t budget = 0;  ///< of triangles: when `made` has more, cutting stops
};

/// `made` counts the triangles of all parts. Vertices come in the order in which triangles use them,
/// triangles along a curve that fills space.
[[nodiscard]] PartPieces cutPart(const scene::WorldGeometry& geometry, const CutOrder& order,
                                 std::atomic<std::size_t>& made);

}  // namespace catoptric::raster
