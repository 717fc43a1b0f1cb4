// SPDX-License-Identifier: Apache-2.0
// The ray of a mirror pixel with its changes per pixel: differences to neighbours on the same mirror. Needs exact_point, and
// before it a function  void readRay(ivec2 pixel, out vec3 origin, out vec3 direction).

uniform usampler2D u_parentIds;

/// Change along one axis; zero where neither neighbour is on the mirror of this pixel.
void readRayStep(ivec2 pixel, ivec2 axis, PixelRay ray, out vec3 originStep, out vec3 directionStep) {
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
  vec3 origin, direction;
  readRay(other, origin, direction);
  originStep = sign * (origin - ray.origin);
  directionStep = sign * (direction - ray.direction);
}

PixelRay readPixelRay(ivec2 pixel) {
  PixelRay ray;
  readRay(pixel, ray.origin, ray.direction);
  readRayStep(pixel, ivec2(1, 0), ray, ray.originDx, ray.directionDx);
  readRayStep(pixel, ivec2(0, 1), ray, ray.originDy, ray.directionDy);
  return ray;
}
