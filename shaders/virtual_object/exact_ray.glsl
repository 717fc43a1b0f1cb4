// SPDX-License-Identifier: Apache-2.0
// The reflected ray of a pixel against a triangle of the scene.

uniform sampler2D u_rayOrigins;
uniform sampler2D u_rayDirections;
uniform usampler2D u_triangles;    // three vertices; part * 4 + 1 if single-sided
uniform sampler2D u_vertices;      // kVertexTexels each, see exact_point.glsl

const int kVertexTexels = 5;

/// In rows of 2048 texels: software rasterizers divide by any other width lane by lane.
ivec2 texelAt(int index) { return ivec2(index & 2047, index >> 11); }

uvec4 readTriangle(uint triangle) {
  return texelFetch(u_triangles, texelAt(int(triangle)), 0);
}

vec4 readVertex(uint vertex, int texel) {
  return texelFetch(u_vertices, texelAt(int(vertex) * kVertexTexels + texel), 0);
}

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
RayHit meetTriangle(vec3 direction, float tNear, vec3 a, vec3 b, vec3 c, vec3 n) {
  vec3 sides = vec3(dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b)));
  RayHit hit;
  hit.across = dot(direction, n);
  hit.isFront = hit.across < 0.0f;
  float sum = sides.x + sides.y + sides.z;
  vec3 inner = hit.isFront ? -sides : sides;
  hit.t = dot(a, n) / hit.across;
  hit.weights = sides / sum;
  hit.isHit = hit.across != 0.0f && min(inner.x, min(inner.y, inner.z)) >= -1.0e-6f * abs(sum) && hit.t > tNear;
  return hit;
}
