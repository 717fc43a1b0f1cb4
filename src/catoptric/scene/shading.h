// SPDX-License-Identifier: Apache-2.0
// The pure functions of shaders/lib/, compiled as C++ so that the ray tracer shades with the rasterizer's
// formulas.
#pragma once

#include <cmath>

#include "catoptric/core/math.h"

namespace catoptric::scene::glsl {

using namespace glm;  // NOLINT: the included files are GLSL
using std::acos;

#define CATOPTRIC_FN inline
#define choose(c, a, b) ((c) ? (a) : (b))
#define anyLane(c) (c)
#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"
#undef CATOPTRIC_FN
#undef choose
#undef anyLane

}  // namespace catoptric::scene::glsl
