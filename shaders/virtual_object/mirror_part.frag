// SPDX-License-Identifier: Apache-2.0
// Which part of a mirror is seen at a pixel.

uniform uint u_number;  // of the part; 0 for what belongs to none

layout(location = 0) out uvec2 o_part;

void main() {
  o_part = uvec2(u_number, 0u);
}
