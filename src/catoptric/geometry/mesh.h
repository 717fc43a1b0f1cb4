// SPDX-License-Identifier: Apache-2.0
// Triangle meshes as our own shapes are made: shared vertices, analytic normals, counter-clockwise from the
// front. Right-handed, y up. Stored as float, computed in double.
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

struct Mesh {
  std::vector<vec3> positions;
  std::vector<vec3> normals;  ///< unit, one per position
  std::vector<vec2> uv;       ///< empty or one per position; v = 0 is the top edge of a texture, as in glTF
  std::vector<vec2> uv1;      ///< a second set, likewise; baked light uses it
  std::vector<vec4> colors;   ///< linear RGBA; empty or one per position
  std::vector<std::uint32_t> indices;  ///< three per triangle

  [[nodiscard]] std::size_t triangleCount() const { return indices.size() / 3; }
};

/// Adds the triangles of `addition`. Optional attributes that only one of the two has are filled with zero
/// (uv) or white (colours).
void append(Mesh& target, const Mesh& addition);

/// The mesh moved by an affine map; normals by the inverse transpose, winding flipped when the map mirrors.
[[nodiscard]] Mesh transformed(Mesh mesh, const dmat4& targetFromMesh);

/// Front and back exchanged.
[[nodiscard]] Mesh flipped(Mesh mesh);

/// Multiplies the texture coordinates, for textures that repeat.
[[nodiscard]] Mesh withScaledUv(Mesh mesh, const vec2& scale);

/// The same triangles without texture coordinates and colours, vertices merged where position and normal
/// agree to within the tolerances, and triangles dropped that become degenerate. What a smooth mirror needs:
/// one vertex for each point of a smooth surface.
[[nodiscard]] Mesh welded(const Mesh& mesh, double positionTolerance, double normalToleranceRadians);

/// Replaces normals by the angle-weighted mean over the faces around each *position* (vertices at the same
/// place are treated as one), so long as the faces meet at less than the crease angle; vertices are split at
/// creases.
[[nodiscard]] Mesh withSmoothNormals(const Mesh& mesh, double creaseAngleRadians);

}  // namespace catoptric::geometry
