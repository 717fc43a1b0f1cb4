// SPDX-License-Identifier: Apache-2.0
// A mirror's pixels from a cube map taken at its centroid (methods.md, section 4). Plain: the cube is looked up in the
// mirror direction. Box-corrected: the mirrored ray is followed to the wall of a box around the room, and the cube is
// looked up in the direction of that point from the centroid.

#include "lib/box_lookup.glsl"
#include "raster/level_pixels.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;
uniform uint u_chain;
uniform samplerCube u_cubeColor;
uniform samplerCube u_cubePosition;  // seen point of each texel; path length from the centroid in a
uniform usamplerCube u_cubeIds;
uniform float u_cubeMaxLod;
uniform vec3 u_centre;               // where the cube was taken, world
uniform vec3 u_boxLower;
uniform vec3 u_boxUpper;
uniform int u_boxCorrected;

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;

vec3 directionAt(ivec2 pixel) {
  vec3 d = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  if (u_boxCorrected == 0) return d;
  return lookUpInBox(u_boxLower, u_boxUpper, u_centre, texelFetch(u_parentPosition, pixel, 0).xyz, d);
}

/// Change of the look-up direction to a neighbour on the same mirror.
vec3 stepAt(ivec2 pixel, ivec2 axis, vec3 here) {
  ivec2 last = textureSize(u_parentIds, 0) - ivec2(1);
  ivec2 next = min(pixel + axis, last);
  if (next == pixel || texelFetch(u_parentIds, next, 0).y != u_parentWord) next = max(pixel - axis, ivec2(0));
  return texelFetch(u_parentIds, next, 0).y == u_parentWord ? directionAt(next) - here : vec3(0.0f);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  vec3 d = directionAt(pixel);
  vec3 dx = stepAt(pixel, ivec2(1, 0), d), dy = stepAt(pixel, ivec2(0, 1), d);
  float texelsPerRadian = float(textureSize(u_cubeColor, 0).x) * 0.63661977f;
  float lod = clamp(0.5f * log2(max(max(dot(dx, dx), dot(dy, dy)) * texelsPerRadian * texelsPerRadian, 1.0e-12f)), 0.0f,
                    u_cubeMaxLod);
  float lower = floor(lod);
  vec3 color = mix(textureLod(u_cubeColor, d, lower).rgb, textureLod(u_cubeColor, d, lower + 1.0f).rgb, lod - lower);
  vec4 seen = textureLod(u_cubePosition, d, 0.0f);
  uint object = textureLod(u_cubeIds, d, 0.0f).x;
  o_radiance = vec4(color, 0.0f);
  o_position = object == 0u ? vec4(seen.xyz, kSkyPath)
                            : vec4(seen.xyz, seen.w + texelFetch(u_parentPosition, pixel, 0).w);
  o_weight = vec4(0.0f);
  o_ids = uvec2(object, u_chain << 16u);
}
