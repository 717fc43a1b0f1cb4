// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the whole target, at the far end of the depth range; no attributes.

void main() {
  vec2 corner = vec2(float((gl_VertexID & 1) << 2) - 1.0f, float((gl_VertexID & 2) << 1) - 1.0f);
  gl_Position = vec4(corner, 1.0f, 1.0f);
}
