// SPDX-License-Identifier: Apache-2.0
// The formulas of shaders/lib that place virtual vertices, compiled as C++ in double: the processor's solvers
// and the vertex shader share one text. And a ray against a triangle, in float.
#pragma once

#include <cmath>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object::formulas {

using namespace glm;  // NOLINT: the included files are GLSL
using Real = double;
using Real2 = dvec2;
using Real3 = dvec3;

#define CATOPTRIC_FN inline
#define choose(c, a, b) ((c) ? (a) : (b))
#define anyLane(c) (c)
#include "lib/mirror_law.glsl"
#include "lib/ray_triangle.glsl"
#include "lib/virtual_vertex.glsl"
#undef CATOPTRIC_FN
#undef choose
#undef anyLane

}  // namespace catoptric::virtual_object::formulas
