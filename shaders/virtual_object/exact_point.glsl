// SPDX-License-Identifier: Apache-2.0
// The point of a triangle that a pixel's reflected ray meets, ready for shading. Needs level_pixels, material,
// surface_shading and exact_ray. Vertex texels: position + uv0.x; normal + uv0.y; tangent; colour; uv1.

/// A ray with its changes per pixel.
struct PixelRay {
  vec3 origin, originDx, originDy;
  vec3 direction, directionDx, directionDy;
};

/// Igehy 1999, equation 10: how the hit moves over the triangle's plane. At grazing rays it goes to infinity; no texture
/// has more levels than the limit asks for.
CATOPTRIC_FN vec3 hitChange(vec3 originStep, vec3 directionStep, vec3 direction, RayHit hit, vec3 normal) {
  vec3 moved = originStep + hit.t * directionStep;
  return clamp(moved - direction * (dot(moved, normal) / hit.across), vec3(-1.0e9f), vec3(1.0e9f));
}

/// Attributes of three corners with their weights.
CATOPTRIC_FN vec4 blendCorners(vec4 a, vec4 b, vec4 c, vec3 weights) { return a * weights.x + b * weights.y + c * weights.z; }

CATOPTRIC_FN SurfacePoint makeSurfacePoint(PixelRay ray, uvec4 corners, RayHit hit, vec3 e1, vec3 e2) {
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

  vec4 facingA = readVertex(corners.x, 1), facingB = readVertex(corners.y, 1), facingC = readVertex(corners.z, 1);
  p.normal = vec3(blendCorners(facingA, facingB, facingC, hit.weights));
  p.mirrorChange = vec2(0.0f);
  if (showsEnvironment()) {
    vec3 normalB = vec3(facingB - facingA), normalC = vec3(facingC - facingA);
    p.mirrorChange = vec2(boundMirrorChange(ray.directionDx, p.normal, normalB * weightsDx.x + normalC * weightsDx.y),
                          boundMirrorChange(ray.directionDy, p.normal, normalB * weightsDy.x + normalC * weightsDy.y));
  }
  vec2 a = vec2(readVertex(corners.x, 0).w, facingA.w);
  vec2 toB = vec2(readVertex(corners.y, 0).w, facingB.w) - a, toC = vec2(readVertex(corners.z, 0).w, facingC.w) - a;
  p.uv0 = a + toB * hit.weights.y + toC * hit.weights.z;
  p.uv0Dx = toB * weightsDx.x + toC * weightsDx.y;
  p.uv0Dy = toB * weightsDy.x + toC * weightsDy.y;
  p.tangent = p.color = vec4(1.0f);
  if (hasTexture(2))
    p.tangent = blendCorners(readVertex(corners.x, 2), readVertex(corners.y, 2), readVertex(corners.z, 2), hit.weights);
  if (hasColors())
    p.color = blendCorners(readVertex(corners.x, 3), readVertex(corners.y, 3), readVertex(corners.z, 3), hit.weights);
  p.uv1 = p.uv1Dx = p.uv1Dy = vec2(0.0f);
  if (hasSecondUv()) {
    a = vec2(readVertex(corners.x, 4));
    toB = vec2(readVertex(corners.y, 4)) - a;
    toC = vec2(readVertex(corners.z, 4)) - a;
    p.uv1 = a + toB * hit.weights.y + toC * hit.weights.z;
    p.uv1Dx = toB * weightsDx.x + toC * weightsDx.y;
    p.uv1Dy = toB * weightsDy.x + toC * weightsDy.y;
  }
  return p;
}
