// SPDX-License-Identifier: Apache-2.0
// Picking an object and moving it with the mouse.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "catoptric/core/math.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::viewer {

/// What a ray from the eye meets first.
struct Grabbed {
  std::uint32_t instance = 0;
  int material = -1;
  dvec3 point{0};  ///< world
};

/// `at`: share of the picture's width and height, from the top left corner; `aspect` is width over height.
/// Holes in masked surfaces are not looked for.
[[nodiscard]] std::optional<Grabbed> findObjectAt(const scene::WorldGeometry& world,
                                                  const scene::Camera& camera, const dvec2& at,
                                                  double aspect);

/// By how much a thing at `point` moves when the mouse moves by `mousePx` (y downwards) and the thing stays
/// under it: in the plane through the point that is parallel to the picture. Metres.
[[nodiscard]] dvec3 findDrag(const scene::Camera& camera, const dvec3& point, const dvec2& mousePx,
                             int heightPx);

/// Corner k of the box of an instance, shifted, in the picture, shares of its width and height from the top
/// left; nothing where the box reaches behind the eye.
[[nodiscard]] std::optional<std::array<dvec2, 8>> findBoxInPicture(const scene::WorldGeometry& world,
                                                                   std::uint32_t instance, const dvec3& shift,
                                                                   const scene::Camera& camera,
                                                                   double aspect);

}  // namespace catoptric::viewer
