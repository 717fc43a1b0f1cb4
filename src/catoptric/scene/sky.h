// SPDX-License-Identifier: Apache-2.0
// The built-in sky, so that a mirror always has something to show. Scene makers may put their lamp where its
// sun is.
#pragma once

#include "catoptric/core/image.h"
#include "catoptric/core/math.h"

namespace catoptric::scene {

/// Unit direction towards the sun of the built-in sky: high, behind the right shoulder of someone who looks
/// along -z.
[[nodiscard]] dvec3 skySunDirection();

/// Linear radiance of the built-in sky as a latitude-longitude map; the same pixels on every run and any
/// number of threads. Directions as in shaders/lib/environment.glsl.
[[nodiscard]] core::ImageRgbF makeSkyImage(int widthPx, int heightPx);

}  // namespace catoptric::scene
