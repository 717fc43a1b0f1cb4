// SPDX-License-Identifier: Apache-2.0
// From primitives of any mode to clean triangles with unit normals.
//
//   1. Vertices in the rest pose (streams.h).
//   2. Indices, each checked against the number of vertices; primitive restart is refused.
//   3. Strips and fans become triangles (glTF 2.0 section 3.7.2.1 fixes their winding).
//   4. Triangles with a NaN, infinite or huge (> 1e15) corner, or without area, are dropped and counted.
//   5. No normals: vertices are split and each triangle gets its flat normal, as the specification says.
//      Zero or NaN normals are replaced by the mean of their triangles' normals, weighted by area.
//   6. Tangents, texture coordinates and colours are checked and repaired; vertices that nothing uses are
//      removed.
//
// Points and lines have no area: a point becomes an octahedron, a line a three-sided prism (points_lines.h).
// Everything is charged to the memory budget before it is allocated. Cost: linear.
#pragma once

#include <span>

#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/gltf/streams.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf {

/// Coordinates beyond this are dropped: their squares must stay finite in 32 bits.
inline constexpr float kLargestCoordinate = 1e15f;

[[nodiscard]] bool isFinite(const vec3& v);
[[nodiscard]] bool isUsable(const vec3& position);

/// Mesh `index` of the document. Primitives of which nothing is left are omitted; `material` is that of the
/// file, or `defaultMaterial`.
/// `keepsDeformation`: an animation may move the vertices; what they are made from is kept beside them.
[[nodiscard]] Mesh readMesh(const Data& data, int index, std::span<const float> weights, const SkinPose* skin,
                            int defaultMaterial, bool keepsDeformation);

}  // namespace catoptric::scene::gltf
