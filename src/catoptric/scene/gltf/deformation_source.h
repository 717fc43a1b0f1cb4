// SPDX-License-Identifier: Apache-2.0
// What the vertices of an animated primitive are made from: base, morph targets, joints (scene/motion.h:
// Deformation).
#pragma once

#include <cstdint>
#include <span>

#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf {

/// `sources`: the file's vertex of each vertex of `made`, which has been read, checked and repaired in its
/// rest pose. Targets with numbers that are not finite count as zero there (warning).
[[nodiscard]] Deformation readDeformation(const Data& data, const Primitive& primitive,
                                          std::span<const std::uint32_t> sources, bool isSkinned,
                                          const MeshPrimitive& made);

}  // namespace catoptric::scene::gltf
