// SPDX-License-Identifier: Apache-2.0
// The reflected ray of a pixel from the textures that exact_rays.frag fills. Needs exact_ray and exact_point.

uniform usampler2D u_parentIds;

/// How the reflected ray changes per pixel along one axis: difference to a neighbour on the same mirror, zero if there is
/// none.
void readRayStep(ivec2 pixel, ivec2 axis, vec3 origin, vec3 direction, out vec3 originStep, out vec3 directionStep) {
  originStep = directionStep = vec3(0.0f);
  ivec2 last = textureSize(u_parentIds, 0) - ivec2(1);
  uint key = texelFetch(u_parentIds, pixel, 0).y;
  ivec2 other = min(pixel + axis, last);
  float sign = 1.0f;
  if (other == pixel || texelFetch(u_parentIds, other, 0).y != key) {
    other = max(pixel - axis, ivec2(0));
    sign = -1.0f;
    if (other == pixel || texelFetch(u_parentIds, other, 0).y != key) return;
  }
  originStep = sign * (texelFetch(u_rayOrigins, other, 0).xyz - origin);
  directionStep = sign * (texelFetch(u_rayDirections, other, 0).xyz - direction);
}

PixelRay readPixelRay(ivec2 pixel) {
  PixelRay ray;
  ray.origin = texelFetch(u_rayOrigins, pixel, 0).xyz;
  ray.direction = texelFetch(u_rayDirections, pixel, 0).xyz;
  readRayStep(pixel, ivec2(1, 0), ray.origin, ray.direction, ray.originDx, ray.directionDx);
  readRayStep(pixel, ivec2(0, 1), ray.origin, ray.direction, ray.originDy, ray.directionDy);
  return ray;
}
