// SPDX-License-Identifier: Apache-2.0
// What the next level shows in a level's mirrors (1998, fig. 1, step 7), to be added to the level's radiance.
// Define EVERYWHERE: it shows something at every pixel of a mirror, and stores no ids.

#include "raster/level_pixels.glsl"

uniform usampler2D u_ids;
uniform sampler2D u_weight;
uniform usampler2D u_nextIds;      // chain 0 = nothing was drawn for this pixel
uniform sampler2D u_nextRadiance;  // composed

layout(location = 0) out vec4 o_radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  bool isShown = reflectorOf(texelFetch(u_ids, pixel, 0).xy) != 0u;
#ifndef EVERYWHERE
  isShown = isShown && chainOf(texelFetch(u_nextIds, pixel, 0).xy) != 0u;
#endif
  if (!isShown) discard;
  o_radiance = vec4(texelFetch(u_weight, pixel, 0).rgb * texelFetch(u_nextRadiance, pixel, 0).rgb, 0.0f);
}
