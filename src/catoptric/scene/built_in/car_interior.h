// SPDX-License-Identifier: Apache-2.0
// The car around the driver of drivers-view: mirrors, cameras, dashboard, pillars, flanks.
#pragma once

#include "catoptric/scene/built_in/scene_builder.h"

namespace catoptric::scene::built_in {

/// Where the driver's eye is: left-hand drive, the car's middle on x = 0, the road on y = 0.
inline const dvec3 kDriversEye(-0.36, 1.22, 0.0);

/// Adds everything, the cameras "driver", "left-mirror", "right-mirror" and "inner-mirror" included.
void addOwnCar(SceneBuilder& builder);

}  // namespace catoptric::scene::built_in
