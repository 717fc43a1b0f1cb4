// SPDX-License-Identifier: Apache-2.0
// Which triangle of the scene is seen at a mirror pixel, and how far away: the level's shading comes later, once a pixel,
// where the pixel is one of the mirror's.

flat in uint v_triangle;
in vec3 v_drawPosition;

uniform vec3 u_drawEye;
uniform sampler2D u_parentPosition;

layout(location = 0) out uvec2 o_hit;  // triangle + 1; bits of the length of the path to it

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float path = length(v_drawPosition - u_drawEye);
  // The second z-buffer of 1998, section 3: nothing lies before the mirror that shows it.
  if (path < texelFetch(u_parentPosition, pixel, 0).w * 0.99999f) discard;
  o_hit = uvec2(v_triangle + 1u, floatBitsToUint(path));
}
