// SPDX-License-Identifier: Apache-2.0
// A virtual triangle that only says which triangle of the scene is seen. In: virtual vertices (draw space); the triangle's
// number at its last corner, from which GL takes what does not vary.

layout(location = 0) in vec3 a_drawPosition;
layout(location = 1) in uint a_triangle;

uniform mat4 u_clipFromDraw;

flat out uint v_triangle;
out vec3 v_drawPosition;

void main() {
  v_triangle = a_triangle;
  v_drawPosition = a_drawPosition;
  gl_Position = u_clipFromDraw * vec4(a_drawPosition, 1.0f);
}
