// SPDX-License-Identifier: Apache-2.0
// The point of a triangle that a pixel's reflected ray meets, ready for shading. Needs level_pixels, material,
// surface_shading and exact_ray. Vertex texels: position + uv0.x; normal + uv0.y; tangent; colour; uv1.
// Defines, by part: ENVIRONMENT = as in raster/surface.frag; COLORS = its vertices have colours; SECOND_UV = and a second set of texture coordinates.

/// A ray with its changes per pixel.
struct PixelRay {
  vec3 origin, originDx, originDy;
  vec3 direction, directionDx, directionDy;
};

/// Igehy 1999, equation 10: how the hit moves over the triangle's plane. At grazing rays it goes to infinity; no texture
/// has more levels than the limit asks for.
vec3 hitChange(vec3 originStep, vec3 directionStep, vec3 direction, RayHit hit, vec3 normal) {
  vec3 moved = originStep + hit.t * directionStep;
  return clamp(moved - direction * (dot(moved, normal) / hit.across), vec3(-1.0e9f), vec3(1.0e9f));
}

SurfacePoint makeSurfacePoint(PixelRay ray, uvec4 corners, RayHit hit, vec3 e1, vec3 e2) {
  vec3 normal = cross(e1, e2);
  float square = dot(normal, normal);
  vec3 gradientB = cross(e2, normal) / square, gradientC = cross(normal, e1) / square;
  SurfacePoint p;
  p.position = ray.origin + hit.t * ray.direction;
  p.toViewer = -ray.direction;
  p.isFront = hit.isFront;
  p.positionDx = hitChange(ray.originDx, ray.directionDx, ray.direction, hit, normal);
  p.positionDy = hitChange(ray.originDy, ray.directionDy, ray.direction, hit, normal);
  vec2 weightsDx = vec2(dot(p.positionDx, gradientB), dot(p.positionDx, gradientC));
  vec2 weightsDy = vec2(dot(p.positionDy, gradientB), dot(p.positionDy, gradientC));

  mat3x4 place = mat3x4(readVertex(corners.x, 0), readVertex(corners.y, 0), readVertex(corners.z, 0));
  mat3x4 facing = mat3x4(readVertex(corners.x, 1), readVertex(corners.y, 1), readVertex(corners.z, 1));
  p.normal = (facing * hit.weights).xyz;
#ifdef ENVIRONMENT
  mat2x3 toNormals = mat2x3((facing[1] - facing[0]).xyz, (facing[2] - facing[0]).xyz);
  p.mirrorChange = vec2(boundMirrorChange(ray.directionDx, p.normal, toNormals * weightsDx),
                        boundMirrorChange(ray.directionDy, p.normal, toNormals * weightsDy));
#endif
  vec2 a = vec2(place[0].w, facing[0].w);
  vec2 toB = vec2(place[1].w, facing[1].w) - a, toC = vec2(place[2].w, facing[2].w) - a;
  p.uv0 = a + toB * hit.weights.y + toC * hit.weights.z;
  p.uv0Dx = toB * weightsDx.x + toC * weightsDx.y;
  p.uv0Dy = toB * weightsDy.x + toC * weightsDy.y;
  p.tangent = mat3x4(readVertex(corners.x, 2), readVertex(corners.y, 2), readVertex(corners.z, 2)) * hit.weights;
  p.color = vec4(1.0f);
#ifdef COLORS
  p.color = mat3x4(readVertex(corners.x, 3), readVertex(corners.y, 3), readVertex(corners.z, 3)) * hit.weights;
#endif
  p.uv1 = p.uv1Dx = p.uv1Dy = vec2(0.0f);
#ifdef SECOND_UV
  a = readVertex(corners.x, 4).xy;
  toB = readVertex(corners.y, 4).xy - a;
  toC = readVertex(corners.z, 4).xy - a;
  p.uv1 = a + toB * hit.weights.y + toC * hit.weights.z;
  p.uv1Dx = toB * weightsDx.x + toC * weightsDx.y;
  p.uv1Dy = toB * weightsDy.x + toC * weightsDy.y;
#endif
  return p;
}
