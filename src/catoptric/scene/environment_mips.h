// SPDX-License-Identifier: Apache-2.0
// Private to scene: the mip chain of a map of linear radiance.
#pragma once

#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::scene {

/// `map` and its reductions to half, quarter, ... down to 1x1; sizes are floor(n / 2), at least 1. Each level
/// has the mean of the one above, odd sizes included, and equal texels stay exactly equal where sizes are
/// even.
[[nodiscard]] std::vector<core::ImageRgbF> makeEnvironmentMips(core::ImageRgbF map);

}  // namespace catoptric::scene
