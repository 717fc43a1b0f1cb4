// SPDX-License-Identifier: Apache-2.0
// The eye, mirrored, and what of the scene it can see through the mirror's pixels (2005, section 17.1.2).
// Draw space is world space here: behind planar mirrors alone nothing else is moved.
#pragma once

#include <array>
#include <vector>

#include "catoptric/raster/reflection_method.h"

namespace catoptric::planar_mirror {

/// The camera of a frame, mirrored through all mirrors of a chain of planar ones, cut at the last one's plane
/// on its far side.
[[nodiscard]] raster::PinholeView makeMirroredView(const raster::FrameContext& frame,
                                                   const raster::Chain& chain);

/// `view` reduced to a rectangle of a picture of widthPx x heightPx, in a target of textureWidth x
/// textureHeight texels.
[[nodiscard]] raster::PinholeView reduceToRectangle(const raster::PinholeView& view,
                                                    const gl::Scissor& rectangle, int widthPx, int heightPx,
                                                    int textureWidth, int textureHeight);

/// The four sides of the pyramid of a rectangle of pixels: dot(xyz, p) + w >= 0 is inside.
[[nodiscard]] std::array<vec4, 4> makeFrustumSides(const raster::PinholeView& view,
                                                   const gl::Scissor& rectangle);

/// Does all of this box lie behind the plane, or in it?
[[nodiscard]] bool isWhollyBehind(const core::Box& box, const vec4& plane);

}  // namespace catoptric::planar_mirror
