// SPDX-License-Identifier: Apache-2.0
// Lines and points of raster/marks.h. In: positions in the world, linear colours.

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_color;

uniform mat4 u_clipFromWorld;

out vec3 v_color;

void main() {
  v_color = a_color;
  gl_Position = u_clipFromWorld * vec4(a_position, 1.0f);
  gl_PointSize = 1.0f;
}
