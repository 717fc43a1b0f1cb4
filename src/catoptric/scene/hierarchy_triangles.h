// SPDX-License-Identifier: Apache-2.0
// The world's triangles as a hierarchy of bounding volumes takes them: the one place that lists them.
#pragma once

#include <span>
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

/// In the flags of a part: its triangles are left out.
inline constexpr std::uint32_t kLeftOut = 0xffffffffu;

/// In the world's order, `triangle` being the world's number; `flags`: by part, of its triangles.
[[nodiscard]] std::vector<geometry::HierarchyTriangle> listTriangles(const WorldGeometry& world,
                                                                     std::span<const std::uint32_t> flags);

/// All of them, with geometry::kTwoSided where they are seen from behind.
[[nodiscard]] std::vector<geometry::HierarchyTriangle> listTriangles(const WorldGeometry& world);

}  // namespace catoptric::scene
