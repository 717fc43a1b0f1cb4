// SPDX-License-Identifier: Apache-2.0
// Erases a pixel of a level of mirrors (raster/level_pixels.glsl), or of its overlay: nothing is there.

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;

void main() {
  o_radiance = o_position = o_weight = vec4(0.0f);
  o_ids = uvec2(0u);
}
