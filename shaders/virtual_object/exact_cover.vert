// SPDX-License-Identifier: Apache-2.0
// A rectangle of mirror pixels in which a triangle may be seen. In: corners of the rectangle in pixels, number of the
// triangle in two halves (floats hold 24 bits). Out: the triangle's corners, world, the same at all four.

#include "virtual_object/exact_ray.glsl"
#ifdef FLAT_CONSTANTS
#include "raster/hand_on_constants.glsl"
#endif

layout(location = 0) in vec4 a_cover;  // x, y; low 12 bits, rest of the triangle's number

uniform vec2 u_targetSizePx;

flat out uint v_triangle;
flat out uint v_part;  // part * 4 + 1 if single-sided
flat out vec3 v_a;
flat out vec3 v_b;
flat out vec3 v_c;
flat out vec3 v_normal;

void main() {
#ifdef FLAT_CONSTANTS
  handOnConstants();
#endif
  v_triangle = uint(a_cover.z) + uint(a_cover.w) * 4096u;
  uvec4 corners = readTriangle(v_triangle);
  v_part = corners.w;
  v_a = readVertex(corners.x, 0).xyz;
  v_b = readVertex(corners.y, 0).xyz;
  v_c = readVertex(corners.z, 0).xyz;
  v_normal = cross(v_b - v_a, v_c - v_a);
  gl_Position = vec4(2.0f * a_cover.xy / u_targetSizePx - vec2(1.0f), 0.0f, 1.0f);
}
