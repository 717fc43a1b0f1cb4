// SPDX-License-Identifier: Apache-2.0
// Blends a level with what its mirrors show (1998, fig. 1, step 7), then blended surfaces over it. Defines, because
// software rasterizers run both sides of an `if`:
//   NEXT         there is a composed next level, which shows something in all mirrors unless ENVIRONMENT is defined, too
//   ENVIRONMENT  mirrors in which nothing was drawn show the environment
//   OVERLAY      there are blended surfaces
//   SEEN         carries along which point is seen

#include "lib/environment.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"

uniform sampler2D u_radiance;
uniform sampler2D u_position;
uniform sampler2D u_weight;
uniform usampler2D u_ids;
uniform sampler2D u_overlay;
uniform usampler2D u_nextIds;          // of the next level: chain 0 = nothing was drawn for this pixel
uniform sampler2D u_nextColor;         // composed
uniform sampler2D u_nextSeenPosition;
uniform usampler2D u_nextSeenIds;

layout(location = 0) out vec4 o_color;
#ifdef SEEN
layout(location = 1) out vec4 o_seenPosition;  // world point (direction for the sky), path length
layout(location = 2) out uvec2 o_seenIds;      // (object + 1) | shell << 31; (own reflector + 1) | bounces << 16
#endif

vec3 readMirroredEnvironment(ivec2 pixel) {
  vec3 d = readMirrorDirection(u_radiance, u_weight, pixel);
  vec3 dx = readMirrorDirectionStep(u_radiance, u_weight, u_ids, pixel, ivec2(1, 0), d);
  vec3 dy = readMirrorDirectionStep(u_radiance, u_weight, u_ids, pixel, ivec2(0, 1), d);
  return lookUpEnvironment(d, dx, dy);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec2 ids = texelFetch(u_ids, pixel, 0).xy;
  vec3 color = texelFetch(u_radiance, pixel, 0).rgb;
  bool isMirror = reflectorOf(ids) != 0u;
#ifdef NEXT
  bool hasNext = isMirror && chainOf(texelFetch(u_nextIds, pixel, 0).xy) != 0u;
#else
  bool hasNext = false;
#endif
#ifdef SEEN
  o_seenPosition = texelFetch(u_position, pixel, 0);
  o_seenIds = uvec2(ids.x, reflectorOf(ids));
#endif
#ifdef NEXT
  if (hasNext) {
    color += texelFetch(u_weight, pixel, 0).rgb * texelFetch(u_nextColor, pixel, 0).rgb;
#ifdef SEEN
    uvec2 seen = texelFetch(u_nextSeenIds, pixel, 0).xy;
    o_seenPosition = texelFetch(u_nextSeenPosition, pixel, 0);
    o_seenIds = uvec2(seen.x, reflectorOf(ids) | (((seen.y >> 16u) + 1u) << 16u));
#endif
  }
#endif
#ifdef ENVIRONMENT
  if (isMirror && !hasNext) color += texelFetch(u_weight, pixel, 0).rgb * readMirroredEnvironment(pixel);
#endif
#ifdef OVERLAY
  vec4 over = texelFetch(u_overlay, pixel, 0);
  color = over.rgb + (1.0f - over.a) * color;
#endif
  o_color = vec4(color, 1.0f);
}
