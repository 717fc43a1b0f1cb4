// SPDX-License-Identifier: Apache-2.0
// A mirror's triangles where the eye sees them. In: position (draw space).

layout(location = 0) in vec3 a_drawPosition;

uniform mat4 u_clipFromDraw;

void main() {
  gl_Position = u_clipFromDraw * vec4(a_drawPosition, 1.0f);
}
