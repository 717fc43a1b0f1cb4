// SPDX-License-Identifier: Apache-2.0
// The reflected ray of a pixel against a triangle of the scene.

#include "lib/ray_triangle.glsl"

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
