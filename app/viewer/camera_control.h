// SPDX-License-Identifier: Apache-2.0
// What the mouse does to the camera: the conventions of glTF viewers and F3D. Pure functions of a camera;
// lengths on the screen are pixels, y downwards.
#pragma once

#include "catoptric/core/math.h"
#include "catoptric/scene/scene.h"

namespace catoptric::viewer {

/// Turns the camera about its target: the scene follows the mouse, 0.4 degrees a pixel; `up` stays up, and
/// the camera stops short of the poles.
void orbit(scene::Camera& camera, const dvec2& mousePx);

/// Shifts eye and target so that what is at the target's distance stays under the mouse.
void pan(scene::Camera& camera, const dvec2& mousePx, int heightPx);

/// Each step up of the wheel goes a tenth of the way to the target, each step down undoes it.
void zoom(scene::Camera& camera, double steps);

/// Makes `point` what orbits go round: the camera turns to it. Does nothing if that is where the eye is.
void setPivot(scene::Camera& camera, const dvec3& point);

/// Sees all of `bounds` from the side the camera is on.
[[nodiscard]] scene::Camera frameAll(const scene::Camera& camera, const core::Box& bounds);

enum class Side { Front, Right, Top };

/// Sees all of `bounds` from +z, +x or +y.
[[nodiscard]] scene::Camera frameFrom(Side side, const scene::Camera& camera, const core::Box& bounds);

[[nodiscard]] bool isSameView(const scene::Camera& a, const scene::Camera& b);

}  // namespace catoptric::viewer
