// SPDX-License-Identifier: Apache-2.0
// Puts a picture of the mirrored scene onto a flat mirror's pixels: texture coordinates are window coordinates within the
// mirror's bounds (2005, section 17.1.2). Radiance is filtered, what cannot be blended is that of the nearest texel.
// Define OVERLAY: the blended surfaces of the picture instead.

#include "raster/level_pixels.glsl"

uniform usampler2D u_parentIds;
uniform uint u_parentWord;     // ids.g of the mirror's pixels
uniform uint u_chain;
uniform vec4 u_bounds;         // of the mirror: x, y, width, height in pixels
uniform sampler2D u_radiance;  // the picture, as in raster/level_pixels.glsl
uniform sampler2D u_position;
uniform sampler2D u_weight;
uniform usampler2D u_ids;
uniform sampler2D u_overlay;

layout(location = 0) out vec4 o_radiance;
#ifndef OVERLAY
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;
#endif

/// Bilinear at `at` texels; 32-bit floats have no filter of their own in GLSL ES 3.00.
vec4 sampleLinear(sampler2D image, vec2 at) {
  vec2 lower = floor(at - vec2(0.5f)), f = at - vec2(0.5f) - lower;
  ivec2 last = textureSize(image, 0) - ivec2(1);
  ivec2 a = clamp(ivec2(lower), ivec2(0), last), b = clamp(ivec2(lower) + ivec2(1), ivec2(0), last);
  vec4 below = mix(texelFetch(image, a, 0), texelFetch(image, ivec2(b.x, a.y), 0), f.x);
  vec4 above = mix(texelFetch(image, ivec2(a.x, b.y), 0), texelFetch(image, b, 0), f.x);
  return mix(below, above, f.y);
}

void main() {
  if (texelFetch(u_parentIds, ivec2(gl_FragCoord.xy), 0).y != u_parentWord) discard;
  vec2 size = vec2(textureSize(u_ids, 0));
  vec2 at = (gl_FragCoord.xy - u_bounds.xy) / u_bounds.zw * size;
#ifdef OVERLAY
  o_radiance = sampleLinear(u_overlay, at);
#else
  ivec2 nearest = min(ivec2(at), ivec2(size) - ivec2(1));
  o_radiance = vec4(sampleLinear(u_radiance, at).rgb, texelFetch(u_radiance, nearest, 0).a);
  o_position = texelFetch(u_position, nearest, 0);
  o_weight = texelFetch(u_weight, nearest, 0);
  uvec2 ids = texelFetch(u_ids, nearest, 0).xy;
  o_ids = uvec2(ids.x, reflectorOf(ids) | (u_chain << 16u));
#endif
}
