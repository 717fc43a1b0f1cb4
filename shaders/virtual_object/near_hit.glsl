// SPDX-License-Identifier: Apache-2.0
// What the pixel's ray meets of the triangle whose virtual image was drawn there. Needs lib/ray_triangle.glsl.

/// Beside the edge of a virtual triangle, straight where its image is curved, the ray may miss the triangle itself. A little
/// off it is right to go on in its plane, which its neighbour often shares; far off, keep the distance at which it was drawn.
CATOPTRIC_FN RayHit keepNear(RayHit hit, float drawn) {
  float outside = -min(hit.weights.x, min(hit.weights.y, hit.weights.z));
  bool isNear = hit.t > 0.0f && (outside < 0.25f || abs(hit.t - drawn) < 0.1f * drawn);
  if (anyLane(!isNear)) {
    vec3 inner = clamp(hit.weights, vec3(0.0f), vec3(1.0f));
    float sum = inner.x + inner.y + inner.z;
    hit.weights = choose(isNear, hit.weights, choose(sum > 0.0f, inner / max(sum, 1.0e-30f), vec3(1.0f / 3.0f)));
    hit.t = choose(isNear, hit.t, drawn);
    hit.across = choose(hit.across == 0.0f, -1.0f, hit.across);  // edge-on: nothing divides by zero
  }
  return hit;
}
