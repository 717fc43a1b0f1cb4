// SPDX-License-Identifier: Apache-2.0
// In: world-space vertices of the scene, and where each is to be drawn (itself, or its virtual vertex).
// Out: clip space; world-space attributes for shading at the real surface point (1998, section 2.1).

#ifdef FLAT_CONSTANTS
#include "raster/hand_on_constants.glsl"
#endif

layout(location = 0) in vec3 a_position;      // world, the real vertex
layout(location = 1) in vec3 a_normal;        // world
layout(location = 2) in vec4 a_tangent;       // world, w = handedness, zero if the mesh has none
layout(location = 3) in vec2 a_uv0;
layout(location = 4) in vec2 a_uv1;
layout(location = 5) in vec4 a_color;
layout(location = 6) in vec3 a_drawPosition;  // draw space: world, or what the planar mirrors before a curved one leave

uniform mat4 u_clipFromDraw;

#if defined(CLIP) && !defined(GL_ES)  // surface.frag does it under GLSL ES 3.00, which has no gl_ClipDistance
uniform vec4 u_clipPlanes[8];         // world: dot(xyz, p) + w >= 0 is drawn
out float gl_ClipDistance[8];
#endif

out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv0;
out vec2 v_uv1;
out vec4 v_color;
out vec3 v_drawPosition;

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
  v_drawPosition = a_drawPosition;
  gl_Position = u_clipFromDraw * vec4(a_drawPosition, 1.0f);
#if defined(CLIP) && !defined(GL_ES)
  for (int i = 0; i < 8; ++i) gl_ClipDistance[i] = dot(u_clipPlanes[i], vec4(a_position, 1.0f));
#endif
}
