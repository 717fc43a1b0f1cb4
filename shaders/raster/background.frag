// SPDX-License-Identifier: Apache-2.0
// Level 0: the environment behind everything, seen directly. Define SEEN: says what is seen, too.

#include "lib/environment.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"

uniform vec3 u_rayOrigin;  // ray direction through the lower left corner of the target, world
uniform vec3 u_rayDx;      // its change per pixel to the right
uniform vec3 u_rayDy;      // its change per pixel upwards

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out uvec2 o_ids;
#ifdef SEEN
layout(location = 2) out vec4 o_position;
#endif

void main() {
  vec3 ray = u_rayOrigin + gl_FragCoord.x * u_rayDx + gl_FragCoord.y * u_rayDy;
  float rayLength = length(ray);
  vec3 d = ray / rayLength;
  vec3 dx = (u_rayDx - d * dot(d, u_rayDx)) / rayLength;
  vec3 dy = (u_rayDy - d * dot(d, u_rayDy)) / rayLength;
  o_radiance = vec4(lookUpEnvironment(d, dx, dy), 0.0f);
  o_ids = uvec2(0u);
#ifdef SEEN
  o_position = vec4(d, kSkyPath);
#endif
}
