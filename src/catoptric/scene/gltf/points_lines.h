// SPDX-License-Identifier: Apache-2.0
// Points and lines have no area, so neither a mirror nor a ray could see them: they become thin solids at
// import. A point becomes an octahedron, a line segment a prism on three sides with caps. Their radius (from
// the axis or centre to a corner) is 0.2 % of the bounding radius of the whole mesh, in the mesh's own frame;
// 0.002 for a mesh without extent. They keep the colour and the texture coordinates of their vertex; their
// normals point away from the axis or centre, those of the file are not used.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "catoptric/scene/gltf/context.h"
#include "catoptric/scene/gltf/model.h"
#include "catoptric/scene/gltf/streams.h"

namespace catoptric::scene::gltf {

[[nodiscard]] VertexStreams thickenPoints(Context& context, const VertexStreams& streams,
                                          std::span<const std::uint32_t> indices, double meshRadius,
                                          const std::string& pointer, std::vector<std::uint32_t>& triangles);

/// `mode` is Lines, LineLoop or LineStrip.
[[nodiscard]] VertexStreams thickenLines(Context& context, const VertexStreams& streams,
                                         std::span<const std::uint32_t> indices, PrimitiveMode mode,
                                         double meshRadius, const std::string& pointer,
                                         std::vector<std::uint32_t>& triangles);

}  // namespace catoptric::scene::gltf
