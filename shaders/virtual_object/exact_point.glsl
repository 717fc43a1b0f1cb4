// SPDX-License-Identifier: Apache-2.0
// The point of a triangle that a pixel's reflected ray meets, ready for shading. Needs level_pixels, material,
// surface_shading and exact_ray. Vertex texels: position + uv0.x; normal + uv0.y; tangent; colour; uv1.

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

/// Igehy 1999, equation 10: how the hit moves over the triangle's plane. At grazing rays it goes to infinity; no texture
/// has more levels than the limit asks for.
vec3 hitChange(vec3 originStep, vec3 directionStep, vec3 direction, RayHit hit, vec3 normal) {
  vec3 moved = originStep + hit.t * directionStep;
  return clamp(moved - direction * (dot(moved, normal) / hit.across), vec3(-1.0e9f), vec3(1.0e9f));
}

SurfacePoint makeSurfacePoint(ivec2 pixel, uvec4 corners, vec3 origin, vec3 direction, RayHit hit, vec3 e1, vec3 e2) {
  vec3 normal = cross(e1, e2), originStep, directionStep;
  float square = dot(normal, normal);
  vec3 gradientB = cross(e2, normal) / square, gradientC = cross(normal, e1) / square;
  SurfacePoint p;
  p.position = origin + hit.t * direction;
  p.toViewer = -direction;
  p.isFront = hit.isFront;
  readRayStep(pixel, ivec2(1, 0), origin, direction, originStep, directionStep);
  p.positionDx = hitChange(originStep, directionStep, direction, hit, normal);
  readRayStep(pixel, ivec2(0, 1), origin, direction, originStep, directionStep);
  p.positionDy = hitChange(originStep, directionStep, direction, hit, normal);
  vec2 weightsDx = vec2(dot(p.positionDx, gradientB), dot(p.positionDx, gradientC));
  vec2 weightsDy = vec2(dot(p.positionDy, gradientB), dot(p.positionDy, gradientC));

  mat3x4 place = mat3x4(readVertex(corners.x, 0), readVertex(corners.y, 0), readVertex(corners.z, 0));
  mat3x4 facing = mat3x4(readVertex(corners.x, 1), readVertex(corners.y, 1), readVertex(corners.z, 1));
  p.normal = (facing * hit.weights).xyz;
  vec2 a = vec2(place[0].w, facing[0].w);
  vec2 toB = vec2(place[1].w, facing[1].w) - a, toC = vec2(place[2].w, facing[2].w) - a;
  p.uv0 = a + toB * hit.weights.y + toC * hit.weights.z;
  p.uv0Dx = toB * weightsDx.x + toC * weightsDx.y;
  p.uv0Dy = toB * weightsDy.x + toC * weightsDy.y;
  p.tangent = mat3x4(readVertex(corners.x, 2), readVertex(corners.y, 2), readVertex(corners.z, 2)) * hit.weights;
  p.color = mat3x4(readVertex(corners.x, 3), readVertex(corners.y, 3), readVertex(corners.z, 3)) * hit.weights;
  a = readVertex(corners.x, 4).xy;
  toB = readVertex(corners.y, 4).xy - a;
  toC = readVertex(corners.z, 4).xy - a;
  p.uv1 = a + toB * hit.weights.y + toC * hit.weights.z;
  p.uv1Dx = toB * weightsDx.x + toC * weightsDx.y;
  p.uv1Dy = toB * weightsDy.x + toC * weightsDy.y;
  return p;
}
