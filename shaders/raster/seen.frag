// SPDX-License-Identifier: Apache-2.0
// Which point is seen at a pixel of a level, directly or in its mirrors. Define NEXT: there is a next level.

#include "raster/level_pixels.glsl"

uniform sampler2D u_position;
uniform usampler2D u_ids;
uniform usampler2D u_nextIds;  // chain 0 = nothing was drawn for this pixel
uniform sampler2D u_nextSeenPosition;
uniform usampler2D u_nextSeenIds;
uniform vec4 u_nextBounds;     // the next level says something in x..z, y..w

layout(location = 0) out vec4 o_position;  // world point (direction for the sky), path length
layout(location = 1) out uvec2 o_ids;      // (object + 1) | shell << 31; (own reflector + 1) | bounces << 16

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec2 ids = texelFetch(u_ids, pixel, 0).xy;
  o_position = texelFetch(u_position, pixel, 0);
  o_ids = uvec2(ids.x, reflectorOf(ids));
#ifdef NEXT
  bool isInside = all(greaterThanEqual(gl_FragCoord.xy, u_nextBounds.xy)) && all(lessThan(gl_FragCoord.xy, u_nextBounds.zw));
  uvec2 next = texelFetch(u_nextIds, pixel, 0).xy;
  if (isInside && reflectorOf(ids) != 0u && chainOf(next) != 0u && (next.x & kUnfollowedBit) == 0u) {
    uvec2 seen = texelFetch(u_nextSeenIds, pixel, 0).xy;
    o_position = texelFetch(u_nextSeenPosition, pixel, 0);
    o_ids = uvec2(seen.x, reflectorOf(ids) | (((seen.y >> 16u) + 1u) << 16u));
  }
#endif
}
