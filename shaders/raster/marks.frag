// SPDX-License-Identifier: Apache-2.0
// Lines and points of raster/marks.h, into the plain targets of a level (level_pixels.glsl): radiance, and ids that name
// no mirror.

in vec3 v_color;

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out uvec2 o_ids;

void main() {
  o_radiance = vec4(v_color, 0.0f);
  o_ids = uvec2(1u, 0u);
}
