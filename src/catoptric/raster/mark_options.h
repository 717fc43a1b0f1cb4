// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "catoptric/core/math.h"

namespace catoptric::raster {

/// What of a method is to be shown. Each method has only some of it.
struct MarkOptions {
  bool virtualObject = true;  ///< Virtual: the scene but its shell where virtual vertices are
  bool tessellation = false;  ///< Virtual: edges of the pieces, as they stand and as they are drawn
  bool cells = true;   ///< Virtual: the mirror's triangles, reflected rays at their corners (1998, fig. 10)
  bool octree = true;  ///< Morphing: octree cells and rays (2004, section 4.2)
  bool zexels = true;  ///< Zexel: zexels of the reference images, as points of the scene
  std::optional<dvec3> point{};  ///< scene point, world: its cell, leaf and path are picked out

  bool operator==(const MarkOptions&) const = default;
};

}  // namespace catoptric::raster
