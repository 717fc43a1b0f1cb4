// SPDX-License-Identifier: Apache-2.0
// Reads a texture at the pixel's place in the target, at a level (flat) or a layer (array), or the face of a cube that
// the pixel's column picks.
uniform sampler2D u_flat;
uniform sampler2DArray u_array;
uniform samplerCube u_cube;
uniform int u_kind;   // 0 flat, 1 array, 2 cube
uniform int u_level;  // or layer
uniform int u_widthPx;
uniform int u_heightPx;
out vec4 o_color;

const vec3 kFaces[6] = vec3[6](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1),
                               vec3(0, 0, -1));

void main() {
  vec2 uv = gl_FragCoord.xy / vec2(float(u_widthPx), float(u_heightPx));
  if (u_kind == 0) o_color = textureLod(u_flat, uv, float(u_level));
  else if (u_kind == 1) o_color = textureLod(u_array, vec3(uv, float(u_level)), 0.0f);
  else o_color = textureLod(u_cube, kFaces[int(gl_FragCoord.x) % 6], 0.0f);
}
