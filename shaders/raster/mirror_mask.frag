// SPDX-License-Identifier: Apache-2.0
// Which pixels of the level before show a mirror, for the stencil: all others are discarded. Define DEPTH: for the depth
// buffer, the farthest there and the nearest everywhere else (2005, section 17.1.2). Writes no colour.

uniform usampler2D u_parentIds;
uniform uint u_parentWord;  // ids.g of the mirror's pixels

void main() {
  bool isMirror = texelFetch(u_parentIds, ivec2(gl_FragCoord.xy), 0).y == u_parentWord;
#ifdef DEPTH
  gl_FragDepth = isMirror ? 1.0f : 0.0f;
#else
  if (!isMirror) discard;
#endif
}
