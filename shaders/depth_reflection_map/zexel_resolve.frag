// SPDX-License-Identifier: Apache-2.0
// The pixels of a flat mirror from warped reference images: each pixel has the number of a zexel that lands on it or
// near. The pixel's own ray is then cut with the plane that this zexel and its neighbours lie in, so that point and
// colour are those of the pixel, not of the zexel. Where no zexel landed, and at the sky, nothing is written: the
// environment is there already.

#include "raster/level_pixels.glsl"
#include "depth_reflection_map/reference.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;
uniform uint u_chain;
uniform usampler2D u_winners;      // zexel + 1 | reference << 30
uniform vec2 u_winnersCorner;      // pixel of the winners' first texel
uniform float u_lod;               // level of the hierarchical map that was warped

uniform sampler2D u_color0;
uniform usampler2D u_zexels0;
uniform mat4 u_worldFromZexel0;
uniform mat4 u_zexelFromWorld0;
uniform vec3 u_centre0;
uniform sampler2D u_color1;
uniform usampler2D u_zexels1;
uniform mat4 u_worldFromZexel1;
uniform mat4 u_zexelFromWorld1;
uniform vec3 u_centre1;

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;

/// What the ray shows of the surface around a zexel. False at the sky.
bool resolve(sampler2D color, usampler2D zexels, mat4 worldFromZexel, mat4 zexelFromWorld, vec3 centre, ivec2 at,
             vec3 from, vec3 direction, out vec3 radiance, out vec3 point, out uint object) {
  ZexelRay ray = makeZexelRay(zexelFromWorld, centre, from, direction);
  uvec2 zexel = texelFetch(zexels, at, 0).xy;
  float d = disparityOf(zexel);
  object = zexel.y;
  radiance = vec3(0.0f);
  point = vec3(0.0f);
  if (object == 0u) return false;
  vec2 z = vec2(at) + vec2(0.5f), p = z;
  for (int i = 0; i < 2; ++i) {  // the second time from the zexel that the ray goes through
    vec2 g = vec2(disparitySlope(zexels, at, ivec2(1, 0), zexel), disparitySlope(zexels, at, ivec2(0, 1), zexel));
    float t = meetZexelPlane(ray, z, disparityOf(zexel), g);
    vec2 met = t > 0.0f ? zexelAt(ray, t) : z;
    if (t < 0.0f || any(greaterThan(abs(met - z), vec2(2.5f * exp2(u_lod))))) break;
    p = met;
    d = 1.0f / (ray.o.z + t * ray.s.z);
    ivec2 next = clamp(ivec2(floor(p)), ivec2(0), textureSize(zexels, 0) - ivec2(1));
    uvec2 other = texelFetch(zexels, next, 0).xy;
    if (next == at || other.y != object || abs(disparityOf(other) - d) > 0.06f * d) break;
    at = next;
    z = vec2(at) + vec2(0.5f);
    zexel = other;
  }
  point = centre + mat3(worldFromZexel) * vec3(p, 1.0f) / d;
  radiance = u_lod > 0.0f ? textureLod(color, p / vec2(textureSize(color, 0)), u_lod).rgb
                          : readZexelColor(color, zexels, p, object);
  return true;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  uint winner = texelFetch(u_winners, pixel - ivec2(u_winnersCorner), 0).x;
  if (winner == 0u) discard;
  int index = int((winner & 0x3fffffffu) - 1u);
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  vec3 direction = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  vec3 radiance, point;
  uint object;
  bool isSurface;
  if ((winner >> 30u) == 0u) {
    int width = textureSize(u_zexels0, 0).x;
    isSurface = resolve(u_color0, u_zexels0, u_worldFromZexel0, u_zexelFromWorld0, u_centre0,
                        ivec2(index % width, index / width), parent.xyz, direction, radiance, point, object);
  } else {
    int width = textureSize(u_zexels1, 0).x;
    isSurface = resolve(u_color1, u_zexels1, u_worldFromZexel1, u_zexelFromWorld1, u_centre1,
                        ivec2(index % width, index / width), parent.xyz, direction, radiance, point, object);
  }
  if (!isSurface) discard;
  o_radiance = vec4(radiance, 0.0f);
  o_position = vec4(point, parent.w + length(point - parent.xyz));
  o_weight = vec4(0.0f);
  o_ids = uvec2(object, u_chain << 16u);
}
