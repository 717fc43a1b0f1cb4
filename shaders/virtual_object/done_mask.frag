// SPDX-License-Identifier: Apache-2.0
// At pixels that are done: no hit, and a depth that nothing is nearer than.

uniform usampler2D u_done;  // its corner lies at u_corner of the target
uniform vec2 u_corner;

layout(location = 0) out uvec2 o_hit;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy - u_corner);
  if (texelFetch(u_done, pixel, 0).x == 0u) discard;
  o_hit = uvec2(0u);
  gl_FragDepth = 0.0f;
}
