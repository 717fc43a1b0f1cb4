// SPDX-License-Identifier: Apache-2.0
// The numbers behind teapotPatches(): indices of control points, patch by patch, and the points (z up).
#pragma once

#include <array>
#include <cstdint>

namespace catoptric::geometry {

extern const std::array<std::array<std::uint16_t, 16>, 32> kTeapotIndices;
extern const std::array<std::array<double, 3>, 294> kTeapotPoints;

}  // namespace catoptric::geometry
