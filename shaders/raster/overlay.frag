// SPDX-License-Identifier: Apache-2.0
// Blended surfaces over a level.

uniform sampler2D u_overlay;  // premultiplied

layout(location = 0) out vec4 o_radiance;

void main() { o_radiance = texelFetch(u_overlay, ivec2(gl_FragCoord.xy), 0); }
