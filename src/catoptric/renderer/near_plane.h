// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::renderer {

/// Near plane for a view: as far away as nothing is cut off, since depth precision goes with it; within sane
/// bounds. Visits every triangle.
[[nodiscard]] double chooseNearPlane(const scene::WorldGeometry& geometry, const scene::CameraFrame& camera);

}  // namespace catoptric::renderer
