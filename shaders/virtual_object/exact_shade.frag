// SPDX-License-Identifier: Apache-2.0
// Step 4 of solver `exact`: shades what the reflected ray of this pixel meets and stores it as surface.frag does.
// Defines: ENVIRONMENT = as in surface.frag; OVERLAY = blended triangles, each tested here; only premultiplied colour is written.

#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"
#include "raster/surface_shading.glsl"
#include "virtual_object/exact_ray.glsl"
#include "virtual_object/exact_point.glsl"

/// From the textures that exact_rays.frag fills.
void readRay(ivec2 pixel, out vec3 origin, out vec3 direction) {
  origin = texelFetch(u_rayOrigins, pixel, 0).xyz;
  direction = texelFetch(u_rayDirections, pixel, 0).xyz;
}

#include "virtual_object/pixel_ray.glsl"

flat in uint v_triangle;

uniform usampler2D u_hits;
uniform uint u_parentWord;  // ids.g that a pixel of the level before must have
uniform uint u_part;
uniform float u_depthFromDistance;
uniform vec3 u_absorption;  // of the solid that a ray goes through if its pixel says so

#ifdef OVERLAY
layout(location = 0) out vec4 o_color;
#else
layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint triangle = v_triangle;
#ifndef OVERLAY
  triangle = texelFetch(u_hits, pixel, 0).x;
  if (triangle == 0u) discard;
  triangle -= 1u;
#endif
  uvec4 corners = readTriangle(triangle);
  if (corners.w >> 2u != u_part || texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;

  vec4 origin = texelFetch(u_rayOrigins, pixel, 0), direction = texelFetch(u_rayDirections, pixel, 0);
  vec3 a = readVertex(corners.x, 0).xyz, e1 = readVertex(corners.y, 0).xyz - a, e2 = readVertex(corners.z, 0).xyz - a;
  a -= origin.xyz;
  RayHit hit = meetTriangle(direction.xyz, direction.w, a, a + e1, a + e2, cross(e1, e2));
#ifdef OVERLAY
  if (!hit.isHit || (!hit.isFront && (corners.w & 1u) != 0u)) discard;
#endif
  SurfacePoint p = makeSurfacePoint(readPixelRay(pixel), corners, hit, e1, e2);
  vec4 base = readBaseColor(p);
  ShadedPoint shaded = shadePoint(p, shadingNormal(p), base.rgb);
  bool isInside = (texelFetch(u_parentIds, pixel, 0).x & kInsideBit) != 0u;
  vec3 left = isInside ? absorbLight(u_absorption, hit.t) : vec3(1.0f);
  gl_FragDepth = min(hit.t * u_depthFromDistance, 0.9999999f);
#ifdef OVERLAY
  o_color = vec4(shaded.radiance * left * base.a, base.a);
#else
  vec2 oct = octahedralFromDirection(shaded.mirrorDirection);
  o_radiance = vec4(shaded.radiance * left, oct.x);
  o_position = vec4(p.position, origin.w + hit.t);
  o_weight = vec4(shaded.weight * left, oct.y);
  o_ids = uvec2(u_objectWord | (isInsideBehind(shaded, p.isFront, isInside) ? kInsideBit : 0u), u_reflectorWord);
#endif
}
