// SPDX-License-Identifier: Apache-2.0
// Where in the primary image may mirrors be seen? Elsewhere nobody has to look for them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::renderer {

/// The pixels between the four planes through the eye that touch a sphere, and two more at each side; clipped
/// to the picture, nothing if none is left. All of the picture for a sphere that reaches behind the eye.
/// `clipFromWorld`: a perspective.
[[nodiscard]] std::optional<gl::Scissor> findSphereRect(const dmat4& clipFromWorld, const dvec3& centre,
                                                        double radius, int widthPx, int heightPx);

/// Likewise the rectangle that holds points of the world and the triangles between them; nothing if one of
/// them does not lie before the eye: then this says nothing.
[[nodiscard]] std::optional<gl::Scissor> findPointsRect(const dmat4& clipFromWorld,
                                                        std::span<const vec3> points, int widthPx,
                                                        int heightPx);

/// Rectangles that hold all pixels of all mirrors; they may overlap. One for the whole picture where several
/// would not be less.
[[nodiscard]] std::vector<gl::Scissor> findMirrorRects(const scene::WorldGeometry& world,
                                                       const dmat4& clipFromWorld, int widthPx, int heightPx);

}  // namespace catoptric::renderer
