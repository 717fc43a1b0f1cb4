// SPDX-License-Identifier: Apache-2.0
// Shades, once a pixel, the triangle whose virtual image virtual_triangle.frag drew there: the pixel's own ray meets the
// real triangle, and what it meets is stored as surface.frag does. Rays come straight from the level before; their changes
// per pixel are those within the 2x2 pixels that are shaded together.
// Defines, besides those of raster/material.glsl and exact_point.glsl:
//   MIRROR, SEEN, ENVIRONMENT  as in raster/surface.frag
//   DEPTH         stores that of the virtual image: surfaces will be drawn over it
//   EDGE          pixels of other mirrors, or of none, lie in between: differences to neighbours that are of this one

#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"
#include "raster/surface_shading.glsl"
#include "virtual_object/exact_ray.glsl"
#include "virtual_object/exact_point.glsl"
#include "virtual_object/near_hit.glsl"

uniform usampler2D u_hits;
uniform uint u_parentWord;  // ids.g that a pixel of the level before must have
uniform uint u_part;
uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform sampler2D u_hitDepth;

layout(location = 0) out vec4 o_radiance;
#ifdef MIRROR
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;
#else
layout(location = 1) out uvec2 o_ids;
#ifdef SEEN
layout(location = 2) out vec4 o_position;
#endif
#endif

void readRay(ivec2 pixel, out vec3 origin, out vec3 direction) {
  origin = texelFetch(u_parentPosition, pixel, 0).xyz;
  direction = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
}

#ifdef EDGE
#include "virtual_object/pixel_ray.glsl"
#else
PixelRay readPixelRay(ivec2 pixel) {
  PixelRay ray;
  readRay(pixel, ray.origin, ray.direction);
  ray.originDx = dFdx(ray.origin);
  ray.originDy = dFdy(ray.origin);
  ray.directionDx = dFdx(ray.direction);
  ray.directionDy = dFdy(ray.direction);
  return ray;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  PixelRay ray = readPixelRay(pixel);
  uvec2 stored = texelFetch(u_hits, pixel, 0).xy;
  uvec4 corners = readTriangle(max(stored.x, 1u) - 1u);
  if (stored.x == 0u || corners.w >> 2u != u_part) discard;
#ifdef EDGE
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
#endif

  float path = texelFetch(u_parentPosition, pixel, 0).w;
  vec3 a = readVertex(corners.x, 0).xyz, e1 = readVertex(corners.y, 0).xyz - a, e2 = readVertex(corners.z, 0).xyz - a;
  a -= ray.origin;
  RayHit hit = meetTriangle(ray.direction, 0.0f, a, a + e1, a + e2, cross(e1, e2));
  hit = keepNear(hit, max(uintBitsToFloat(stored.y) - path, 0.0f));
  hit.isFront = hit.isFront || (corners.w & 1u) != 0u;
  SurfacePoint p = makeSurfacePoint(ray, corners, hit, e1, e2);
  vec4 base = readBaseColor(p);
  ShadedPoint shaded = shadePoint(p, shadingNormal(p), base.rgb);
#ifdef DEPTH
  gl_FragDepth = texelFetch(u_hitDepth, pixel, 0).x;
#endif
#ifdef MIRROR
  vec2 oct = octahedralFromDirection(shaded.mirrorDirection);
  o_radiance = vec4(shaded.radiance, oct.x);
  o_position = vec4(p.position, path + hit.t);
  o_weight = vec4(shaded.weight, oct.y);
  o_ids = uvec2(u_objectWord | (isInsideBehind(shaded, p.isFront, false) ? kInsideBit : 0u), u_reflectorWord);
#else
  o_radiance = vec4(shaded.radiance, 0.0f);
  o_ids = uvec2(u_objectWord, u_reflectorWord);
#ifdef SEEN
  o_position = vec4(p.position, path + hit.t);
#endif
#endif
}
