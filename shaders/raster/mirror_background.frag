// SPDX-License-Identifier: Apache-2.0
// Level > 0: the environment in the mirror direction, exact at every pixel, behind the virtual objects. Define SEEN:
// says what is seen, too.

#include "lib/environment.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;  // ids.g of the mirror's pixels
uniform uint u_chain;
uniform uint u_objectWord;  // ids.r: 0, or kUnfollowedBit

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out uvec2 o_ids;
#ifdef SEEN
layout(location = 2) out vec4 o_position;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  vec3 d = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  vec3 dx = readMirrorDirectionStep(u_parentRadiance, u_parentWeight, u_parentIds, pixel, ivec2(1, 0), d);
  vec3 dy = readMirrorDirectionStep(u_parentRadiance, u_parentWeight, u_parentIds, pixel, ivec2(0, 1), d);
  o_radiance = vec4(lookUpEnvironment(d, dx, dy), 0.0f);
  o_ids = uvec2(u_objectWord, u_chain << 16u);
#ifdef SEEN
  o_position = vec4(d, kSkyPath);
#endif
}
