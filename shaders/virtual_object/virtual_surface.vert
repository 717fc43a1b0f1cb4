// SPDX-License-Identifier: Apache-2.0
// raster/surface.vert with the virtual vertex found here. In: world-space vertices of the tessellated scene. Out: as there,
// and what raster/placed_triangle.glsl needs to tell which triangles are worth drawing. Defines: see virtual_vertex.glsl.

#include "virtual_object/virtual_vertex.glsl"

#ifdef FLAT_CONSTANTS
#include "raster/hand_on_constants.glsl"
#endif

layout(location = 0) in vec3 a_position;  // world
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_tangent;
layout(location = 3) in vec2 a_uv0;
layout(location = 4) in vec2 a_uv1;
layout(location = 5) in vec4 a_color;

uniform mat4 u_clipFromDraw;
uniform mat4 u_drawFromWorld;  // flat mirrors behind the curved one
uniform vec3 u_mirrorCentre;   // draw space

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
out vec3 v_drawPosition;
out vec3 v_towardsMirror;  // world axes
out vec2 v_kinds;          // 1 at a vertex that is not there; 0 at a hidden one

void main() {
#ifdef FLAT_CONSTANTS
  handOnConstants();
#endif
  v_position = a_position;
  v_normal = a_normal;
  v_tangent = a_tangent;
  v_uv0 = a_uv0;
  v_uv1 = a_uv1;
  v_color = a_color;
  vec3 scenePoint = (u_drawFromWorld * vec4(a_position, 1.0f)).xyz - u_mirrorCentre;
  VirtualVertex vertex = findVirtualVertex(scenePoint);
  v_towardsMirror = transpose(mat3(u_drawFromWorld)) * (vertex.onMirror - scenePoint);
  v_kinds = vec2(vertex.kind == kNone ? 1.0f : 0.0f, vertex.kind == kDoublyVirtual ? 0.0f : 1.0f);
  v_drawPosition = vertex.position + u_mirrorCentre;
  gl_Position = u_clipFromDraw * vec4(v_drawPosition, 1.0f);
}
