// SPDX-License-Identifier: Apache-2.0
// Question: with how many fewer triangles would a mesh look the same from afar?
//
// In:  a mesh, in any units, with the attributes that its material looks at.
// Out: lists of triangles over the same vertices, each about a third as long as the one before, and by how
//      much each of them misses the mesh.
// Steps:
//   1. Vertices that agree in all that matters count as one.
//   2. Borders, and seams of normals or texture coordinates, keep all their vertices: meshes that meet there
//      fit together whichever level each of them shows. (Vertices at one place that are not one are moved
//      apart by a rounding, so that the simplifier sees borders there.)
//   3. meshopt_simplify (quadric error metric, Garland & Heckbert 1997), from each level to the next.
//   4. The error of a level is measured, not believed: each vertex of the mesh looks for the nearest point of
//      the level within its own connected piece, and points on the edges and in the middle of each of the
//      level's triangles look for the mesh.
// The chain ends where little is gained, or where a level has nothing left to do with the mesh.
// Cost: 20 to 30 ms for 12,500 triangles on one core of an AMD EPYC.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

/// All spans but `indices` are as long as `positions`; those after it may be empty: that attribute does not
/// matter. Every number is finite, indices are in range, three per triangle.
struct SimplifiableMesh {
  std::span<const vec3> positions, normals;
  std::span<const std::uint32_t> indices;
  std::span<const vec2> uv0{}, uv1{};
  std::span<const vec4> tangents{}, colors{};
};

struct SimplifiedLevel {
  std::vector<std::uint32_t> indices;
  double distance = 0;       ///< largest one between the surfaces, and by which a texture slips; mesh units
  double normalRadians = 0;  ///< largest angle between normals (or tangents) at a point of both
  double color = 0;          ///< largest difference of a vertex colour
};

struct SimplificationOptions {
  std::size_t fewestTriangles = 64;
  double largestDistance = 0.05;  ///< of the mesh's bounding radius
  double largestTurn = 0.25;      ///< radians
};

/// From fine to coarse, without the mesh itself; empty where nothing can be left out. Deterministic.
[[nodiscard]] std::vector<SimplifiedLevel> makeSimplifiedLevels(const SimplifiableMesh& mesh,
                                                                const SimplificationOptions& options = {});

}  // namespace catoptric::geometry
