// SPDX-License-Identifier: Apache-2.0
// A mirror's pixels by inverse warping (McMillan 1997; the future work of Bastos & Stuerzlinger 1998): the mirrored ray of
// each pixel is followed through one or two cubes of points seen from a centre, up to where it first goes behind them.
//   1. to 3. cube_ray.glsl: the ray through one cube.
//   4. The second cube is asked where the first is unsure; a sure answer is taken before an unsure one, else the nearer.
// At the end of an arc is the environment, which is there already: nothing is written.

#include "raster/level_pixels.glsl"
#include "depth_reflection_map/cube_ray.glsl"
#include "depth_reflection_map/exposure.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;
uniform uint u_chain;
uniform float u_step;            // radians
uniform int u_cubeCount;
uniform bool u_marksExposures;   // what no cube has surely seen
uniform samplerCube u_color0;
uniform samplerCube u_position0;  // world point, distance from the centre
uniform usamplerCube u_ids0;
uniform vec3 u_centre0;
uniform samplerCube u_color1;
uniform samplerCube u_position1;
uniform usamplerCube u_ids1;
uniform vec3 u_centre1;

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  vec3 direction = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  CubeAnswer answer = followThroughCube(u_position0, u_ids0, u_centre0, parent.xyz, direction, u_step);
  bool fromSecond = false;
  // 4
  if (!answer.isSure && u_cubeCount > 1) {
    CubeAnswer other = followThroughCube(u_position1, u_ids1, u_centre1, parent.xyz, direction, u_step);
    if (other.isSure || other.t < answer.t) {
      answer = other;
      fromSecond = true;
    }
  }
  if (u_marksExposures && !answer.isSure) {
    o_radiance = vec4(kExposureColor, 0.0f);
    o_position = vec4(direction, kSkyPath);
    o_weight = vec4(0.0f);
    o_ids = uvec2(0u, u_chain << 16u);
    return;
  }
  if (answer.object == 0u) discard;
  vec3 radiance = fromSecond ? textureLod(u_color1, answer.direction, 0.0f).rgb
                             : textureLod(u_color0, answer.direction, 0.0f).rgb;
  o_radiance = vec4(radiance, 0.0f);
  o_position = vec4(parent.xyz + answer.t * direction, parent.w + answer.t);
  o_weight = vec4(0.0f);
  o_ids = uvec2(answer.object, u_chain << 16u);
}
