// SPDX-License-Identifier: Apache-2.0
// The vertices of one primitive in the rest pose, as the file gives them: not yet checked for NaN or unit
// length.
//   1. Read the attributes (POSITION, NORMAL, TANGENT, TEXCOORD_0 and 1, COLOR_0).
//   2. Add the morph targets times their default weights.
//   3. Skinned: move each vertex by the weighted sum of its joints' matrices, which puts it into the world
//      at once (the node's own transform does not count, glTF 2.0 section 3.7.3.3).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/scene/gltf/data.h"

namespace catoptric::scene::gltf {

struct VertexStreams {
  std::vector<vec3> positions;
  std::vector<vec3> normals;  ///< Empty if absent, like all that follow.
  std::vector<vec4> tangents;
  std::vector<vec2> uv[2];
  std::vector<vec4> colors;
  std::vector<std::uint32_t> sources;  ///< Which vertex of the file each was; empty: not kept.
  bool flipWinding = false;            ///< The skin mirrors.

  [[nodiscard]] std::size_t size() const { return positions.size(); }
};

/// A skin in its rest pose.
struct SkinPose {
  std::vector<dmat4> worldFromVertex;  ///< For each joint: its world matrix times its inverse bind matrix.
  dmat4 worldFromNode{1.0};            ///< For primitives without joints.
};

/// `weights` are those of the morph targets (empty: all zero); `skin` may be null. `pointer` is the
/// primitive's.
[[nodiscard]] VertexStreams readStreams(const Data& data, const Primitive& primitive,
                                        std::span<const float> weights, const SkinPose* skin,
                                        const std::string& pointer);

/// The streams with vertex `order[i]` in place i (a vertex may occur often or never).
[[nodiscard]] VertexStreams reorder(const VertexStreams& streams, std::span<const std::uint32_t> order);

/// Memory that one vertex of `streams` takes.
[[nodiscard]] std::size_t bytesPerVertex(const VertexStreams& streams);

}  // namespace catoptric::scene::gltf
