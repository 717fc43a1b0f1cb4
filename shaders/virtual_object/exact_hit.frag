// SPDX-License-Identifier: Apache-2.0
// Step 3 of solver `exact`: does the reflected ray of this pixel meet the triangle? The depth buffer keeps the nearest.
// Defines: MASKED = triangles of an alpha-masked material; cut-out texels are not there.

#ifdef MASKED
#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"
#include "raster/surface_shading.glsl"
#endif
#include "virtual_object/exact_ray.glsl"
#ifdef MASKED
#include "virtual_object/exact_point.glsl"

/// From the textures that exact_rays.frag fills.
void readRay(ivec2 pixel, out vec3 origin, out vec3 direction) {
  origin = texelFetch(u_rayOrigins, pixel, 0).xyz;
  direction = texelFetch(u_rayDirections, pixel, 0).xyz;
}

#include "virtual_object/pixel_ray.glsl"
#endif

flat in uint v_triangle;
flat in uint v_part;
flat in vec3 v_a;
flat in vec3 v_b;
flat in vec3 v_c;
flat in vec3 v_normal;

uniform float u_depthFromDistance;
uniform uint u_ownPart;  // of the mirror itself: a ray does not meet the triangle that it starts on

layout(location = 0) out uvec2 o_hit;  // triangle + 1; bits of the distance

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 origin = texelFetch(u_rayOrigins, pixel, 0).xyz;
  vec4 direction = texelFetch(u_rayDirections, pixel, 0);
  vec3 a = v_a - origin;
  RayHit hit = meetTriangle(direction.xyz, direction.w, a, v_b - origin, v_c - origin, v_normal);
  if (!hit.isHit || (!hit.isFront && (v_part & 1u) != 0u)) discard;
  if (v_part >> 2u == u_ownPart && abs(dot(a, v_normal)) <= 2.0f * direction.w * length(v_normal)) discard;
#ifdef MASKED
  if (isCutOut(readBaseColor(makeSurfacePoint(readPixelRay(pixel), readTriangle(v_triangle), hit, v_b - v_a, v_c - v_a))))
    discard;
#endif
  o_hit = uvec2(v_triangle + 1u, floatBitsToUint(hit.t));
  gl_FragDepth = min(hit.t * u_depthFromDistance, 0.9999999f);
}
