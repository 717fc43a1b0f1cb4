// SPDX-License-Identifier: Apache-2.0
// Step 1 of solver `exact`: the reflected ray of every mirror pixel of a level, in two textures that later passes read
// often. A pixel without a mirror gets direction zero, which meets nothing.

#include "raster/level_pixels.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;

layout(location = 0) out vec4 o_origin;     // world point on the mirror; length of the path to it
layout(location = 1) out vec4 o_direction;  // unit; distance at which the ray may begin to hit

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  o_origin = texelFetch(u_parentPosition, pixel, 0);
  o_direction = vec4(0.0f);
  if (reflectorOf(texelFetch(u_parentIds, pixel, 0).xy) == 0u) return;
  o_direction = vec4(readMirrorDirection(u_parentRadiance, u_parentWeight, pixel), findRayBegin(o_origin.xyz));
}
