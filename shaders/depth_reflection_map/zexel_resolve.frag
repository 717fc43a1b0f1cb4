// SPDX-License-Identifier: Apache-2.0
// The pixels of a flat mirror from warped reference images: each pixel has the number of a zexel that lands on it or
// near. From there the pixel's own ray is followed through the reference, so that point and colour are those of the pixel,
// not of the zexel, and a splat that reaches over the edge of its surface does not show there. Where no zexel landed, and at
// the sky, nothing is written: the environment is there already.

#include "raster/level_pixels.glsl"
#include "depth_reflection_map/reference.glsl"
#include "depth_reflection_map/exposure.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;
uniform uint u_chain;
uniform usampler2D u_winners;      // zexel + 1 | reference << 30
uniform vec2 u_winnersCorner;      // pixel of the winners' first texel
uniform int u_count;                // of references, 1 or 2
uniform float u_lod;               // level of the hierarchical map that was warped

uniform sampler2D u_color0;
uniform usampler2D u_zexels0;
uniform mat4 u_zexelFromWorld0;
uniform vec3 u_centre0;
uniform sampler2D u_color1;
uniform usampler2D u_zexels1;
uniform mat4 u_zexelFromWorld1;
uniform vec3 u_centre1;

const uint kExposed = 0xffffffffu;  // instead of a winner

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;

vec3 readColor(sampler2D color, usampler2D zexels, ZexelRay ray, ZexelAnswer answer) {
  vec2 position = zexelAt(ray, answer.t);
  return u_lod > 0.0f ? textureLod(color, position / vec2(textureSize(color, 0)), u_lod).rgb
                      : readZexelColor(color, zexels, position, answer.at);
}

/// The zexel at its own depth along the ray: what a splat shows where the ray misses the zexel's plane by more than planes are
/// continued. A 3x3 splat does where many zexels fall on a pixel.
ZexelAnswer standAtZexel(usampler2D zexels, ZexelRay ray, ivec2 at) {
  return ZexelAnswer((1.0f / disparityOf(texelFetch(zexels, at, 0).xy) - ray.o.z) / ray.s.z, at, false);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  uint winner = texelFetch(u_winners, pixel - ivec2(u_winnersCorner), 0).x;
  if (winner == 0u) discard;
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  vec3 direction = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  if (winner == kExposed) {
    o_radiance = vec4(kExposureColor, 0.0f);
    o_position = vec4(direction, kSkyPath);
    o_weight = vec4(0.0f);
    o_ids = uvec2(0u, u_chain << 16u);
    return;
  }
  ZexelRay ray0 = makeZexelRay(u_zexelFromWorld0, u_centre0, parent.xyz, direction);
  ZexelRay ray1 = makeZexelRay(u_zexelFromWorld1, u_centre1, parent.xyz, direction);
  int index = int((winner & 0x3fffffffu) - 1u);
  bool isFirst = (winner >> 30u) == 0u;
  float reach = 2.5f * exp2(u_lod);
  int width = isFirst ? textureSize(u_zexels0, 0).x : textureSize(u_zexels1, 0).x;
  ivec2 start = ivec2(index % width, index / width);
  ZexelAnswer answer = isFirst ? followZexels(u_zexels0, ray0, start, reach) : followZexels(u_zexels1, ray1, start, reach);
  if (answer.t < 0.0f) answer = isFirst ? standAtZexel(u_zexels0, ray0, start) : standAtZexel(u_zexels1, ray1, start);
  // Where this image cannot tell, the other is asked about the same point.
  if (!answer.isSure && answer.t > 0.0f && u_count > 1) {
    vec2 there = isFirst ? zexelAt(ray1, answer.t) : zexelAt(ray0, answer.t);
    ZexelAnswer other = isFirst ? followZexels(u_zexels1, ray1, ivec2(floor(there)), reach)
                                : followZexels(u_zexels0, ray0, ivec2(floor(there)), reach);
    if (other.isSure) {
      answer = other;
      isFirst = !isFirst;
    }
  }
  if (answer.t < 0.0f || answer.t >= kSkyPath) discard;
  vec3 radiance = isFirst ? readColor(u_color0, u_zexels0, ray0, answer) : readColor(u_color1, u_zexels1, ray1, answer);
  uint object = isFirst ? texelFetch(u_zexels0, answer.at, 0).y : texelFetch(u_zexels1, answer.at, 0).y;
  o_radiance = vec4(radiance, 0.0f);
  o_position = vec4(parent.xyz + answer.t * direction, parent.w + answer.t);
  o_weight = vec4(0.0f);
  o_ids = uvec2(object, u_chain << 16u);
}
