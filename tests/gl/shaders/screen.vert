// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the target.
void main() {
  gl_Position = vec4(float((gl_VertexID & 1) << 2) - 1.0f, float((gl_VertexID & 2) << 1) - 1.0f, 0.0f, 1.0f);
}
