// SPDX-License-Identifier: Apache-2.0
// Virtual vertices as a picture of floats, one pixel each: how a test holds the vertex shader to the processor's solvers.
// In: scene points, draw space. Defines: see virtual_vertex.glsl.

#include "virtual_object/virtual_vertex.glsl"

layout(location = 0) in vec3 a_position;

uniform vec3 u_mirrorCentre;
uniform vec2 u_targetSizePx;

flat out vec4 v_vertex;  // Q', draw space; kind

void main() {
  VirtualVertex vertex = findVirtualVertex(a_position - u_mirrorCentre);
  v_vertex = vec4(vertex.position + u_mirrorCentre, float(vertex.kind));
  int width = int(u_targetSizePx.x);
  vec2 pixel = vec2(float(gl_VertexID % width), float(gl_VertexID / width)) + vec2(0.5f);
  gl_Position = vec4(2.0f * pixel / u_targetSizePx - vec2(1.0f), 0.0f, 1.0f);
  gl_PointSize = 1.0f;
}
