// SPDX-License-Identifier: Apache-2.0
// A ray against a triangle. Compiled by C++ too; eight rays side by side: virtual_object/exact/ray_tests.cpp.

/// Where a ray meets a triangle; `weights` of its three corners.
struct RayHit {
  bool isHit;
  bool isFront;
  float t;
  vec3 weights;
  float across;  // dot(direction, normal), the normal not unit
};

/// a, b, c: the corners as seen from the ray's origin; n: cross(b - a, c - a). Sides of the ray are told from the edges
/// themselves, so that neighbours that share one leave no gap between them.
CATOPTRIC_FN RayHit meetTriangle(vec3 direction, float tNear, vec3 a, vec3 b, vec3 c, vec3 n) {
  vec3 sides = vec3(dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b)));
  RayHit hit;
  hit.across = dot(direction, n);
  hit.isFront = hit.across < 0.0f;
  float sum = sides.x + sides.y + sides.z;
  vec3 inner = sides * choose(hit.isFront, -1.0f, 1.0f);
  hit.t = dot(a, n) / hit.across;
  hit.weights = sides / sum;
  hit.isHit = hit.across != 0.0f && min(inner.x, min(inner.y, inner.z)) >= -1.0e-6f * abs(sum) && hit.t > tNear;
  return hit;
}
