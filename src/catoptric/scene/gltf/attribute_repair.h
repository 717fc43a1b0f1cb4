// SPDX-License-Identifier: Apache-2.0
// Makes attributes fit for use: unit normals and tangents, finite texture coordinates, colours in 0..1.
// Each repair is counted in the context.
#pragma once

#include <cstdint>
#include <span>

#include "catoptric/scene/gltf/context.h"
#include "catoptric/scene/gltf/streams.h"

namespace catoptric::scene::gltf {

/// Unit normals; zero and non-finite ones become the area-weighted mean of the vertex's triangles.
void repairNormals(Context& context, VertexStreams& streams, std::span<const std::uint32_t> triangles);

/// Unit tangents with a handedness of 1 or -1; hopeless ones become any direction at right angles to the
/// normal.
void repairTangents(Context& context, VertexStreams& streams);
void repairTexCoords(Context& context, VertexStreams& streams);
void repairColors(Context& context, VertexStreams& streams);

/// Some unit vector at right angles to the unit vector `v`.
[[nodiscard]] dvec3 anyPerpendicular(const dvec3& v);

}  // namespace catoptric::scene::gltf
