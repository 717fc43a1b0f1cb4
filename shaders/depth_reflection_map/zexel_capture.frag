// SPDX-License-Identifier: Apache-2.0
// Turns a composed level, seen through a mirror from behind it, into zexels (Bastos & Stuerzlinger 1998, section 4):
//   color    linear radiance
//   zexel    r: bits of the disparity, near / depth with near the distance of the mirror's plane (eq. 4, far = infinity),
//               0 at the sky        g: (object + 1) | shell << 31

uniform sampler2D u_color;
uniform sampler2D u_position;  // world
uniform usampler2D u_ids;
uniform vec3 u_centre;         // of projection, world
uniform vec3 u_forward;        // unit, normal of the image plane
uniform float u_planeDistance;

layout(location = 0) out vec4 o_color;
layout(location = 1) out uvec2 o_zexel;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint object = texelFetch(u_ids, pixel, 0).x;
  float disparity = 0.0f;
  if (object != 0u) {
    float depth = dot(texelFetch(u_position, pixel, 0).xyz - u_centre, u_forward);
    disparity = clamp(u_planeDistance / max(depth, 1.0e-20f), 0.0f, 1.0f);
  }
  o_color = vec4(texelFetch(u_color, pixel, 0).rgb, 1.0f);
  o_zexel = uvec2(floatBitsToUint(disparity), object);
}
