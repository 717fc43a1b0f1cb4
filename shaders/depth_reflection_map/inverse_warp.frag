// SPDX-License-Identifier: Apache-2.0
// A mirror's pixels by inverse warping (McMillan 1997; the future work of Bastos & Stuerzlinger 1998): the mirrored ray of
// each pixel is followed through one or two cubes of points seen from a centre, up to where it first goes behind them.
//   1. Seen from the centre c the ray p + t r sweeps an arc, from p - c (t = 0) to r (t = infinity). At the angle a of an
//      arc A long its distance from c is |p - c| sin A / sin (A - a).
//   2. Steps of u_step radians along the arc; where the ray comes to lie behind what the cube shows, the step is halved
//      down to a texel.
//   3. The texel there and its neighbours on the same object give a plane; the ray is cut with it. If it meets it near that
//      texel, that is the answer. Else the ray went behind a silhouette, where this cube knows nothing: the search goes
//      on until the ray comes out again, and the answer is marked as unsure.
//   4. The second cube is asked where the first is unsure; a sure answer is taken before an unsure one, else the nearer.
// At the end of an arc is the environment, which is there already: nothing is written.

#include "raster/level_pixels.glsl"

uniform sampler2D u_parentRadiance;
uniform sampler2D u_parentPosition;
uniform sampler2D u_parentWeight;
uniform usampler2D u_parentIds;
uniform uint u_parentWord;
uniform uint u_chain;
uniform float u_step;            // radians
uniform int u_cubeCount;
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

const int kMostSteps = 512;
const int kHalvings = 6;
const float kSameSurface = 0.06f;  // of the distance, between neighbouring texels

struct Answer {
  float t;       // along the ray; kSkyPath at the sky
  uint object;
  bool isSure;
  vec3 direction;  // from the centre to the point
};

/// Step 3. Where the ray meets the plane of the texel in direction w; false if that is nowhere near.
bool meetTexelPlane(samplerCube position, usamplerCube ids, vec3 centre, vec3 p, vec3 r, vec3 w, vec3 sideways,
                    float texel, inout float t) {
  vec4 here = textureLod(position, w, 0.0f);
  uint object = textureLod(ids, w, 0.0f).x;
  vec3 upwards = cross(w, sideways);
  vec3 edges[2];
  for (int i = 0; i < 2; ++i) {
    vec3 axis = (i == 0 ? sideways : upwards) * (1.5f * texel);
    vec4 ahead = textureLod(position, w + axis, 0.0f), behind = textureLod(position, w - axis, 0.0f);
    bool isAhead = textureLod(ids, w + axis, 0.0f).x == object && abs(ahead.w - here.w) < kSameSurface * here.w;
    bool isBehind = textureLod(ids, w - axis, 0.0f).x == object && abs(behind.w - here.w) < kSameSurface * here.w;
    if (isAhead && (!isBehind || abs(ahead.w - here.w) < abs(here.w - behind.w))) edges[i] = ahead.xyz - here.xyz;
    else if (isBehind) edges[i] = here.xyz - behind.xyz;
    else edges[i] = axis * here.w;
  }
  vec3 n = cross(edges[0], edges[1]);
  float slope = dot(n, r);
  float met = dot(n, here.xyz - p) / slope;
  vec3 v = p + met * r - centre;
  float reach = 2.5f * texel * length(v);
  if (abs(slope) < 1.0e-12f * dot(n, n) || met <= 0.0f) return false;
  if (length(cross(v, w)) > reach || dot(v, w) <= 0.0f) return false;
  t = met;
  return true;
}

Answer follow(samplerCube position, usamplerCube ids, vec3 centre, vec3 p, vec3 r) {
  Answer answer;
  answer.t = kSkyPath;
  answer.object = 0u;
  answer.isSure = true;
  answer.direction = r;
  // 1
  vec3 v0 = p - centre;
  float start = max(length(v0), 1.0e-12f);
  vec3 e1 = v0 / start;
  vec3 across = r - e1 * dot(e1, r);
  float sine = length(across);
  float arc = atan(sine, dot(e1, r));
  vec3 e2 = across / max(sine, 1.0e-12f);
  float texel = 2.0f / float(textureSize(position, 0).x);
  // 2
  float previous = 0.0f;
  bool wasBehind = false;
  int steps = int(min(float(kMostSteps), ceil(arc / u_step)));
  for (int i = 0; i <= steps; ++i) {
    float angle = min((float(i) + 0.5f) * u_step, arc);
    vec3 w = cos(angle) * e1 + sin(angle) * e2;
    float reach = angle < arc ? start * sine / max(sin(arc - angle), 1.0e-12f) : kSkyPath;
    bool isBehind = reach > textureLod(position, w, 0.0f).w;
    if (isBehind && !wasBehind) {
      float low = previous, high = angle;
      for (int k = 0; k < kHalvings; ++k) {
        float middle = 0.5f * (low + high);
        vec3 m = cos(middle) * e1 + sin(middle) * e2;
        float at = middle < arc ? start * sine / max(sin(arc - middle), 1.0e-12f) : kSkyPath;
        if (at > textureLod(position, m, 0.0f).w) high = middle;
        else low = middle;
      }
      // 3. The surface may be that of the texel before as well.
      for (int k = 0; k < 2; ++k) {
        float a = k == 0 ? high : low;
        vec3 m = cos(a) * e1 + sin(a) * e2;
        if (textureLod(ids, m, 0.0f).x == 0u) continue;
        float t = 0.0f;
        if (meetTexelPlane(position, ids, centre, p, r, m, cross(e1, e2), texel, t)) {
          answer.t = t;
          answer.object = textureLod(ids, m, 0.0f).x;
          answer.direction = p + t * r - centre;
          return answer;
        }
      }
      answer.isSure = false;
    }
    wasBehind = isBehind;
    previous = angle;
  }
  return answer;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) discard;
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  vec3 direction = readMirrorDirection(u_parentRadiance, u_parentWeight, pixel);
  Answer answer = follow(u_position0, u_ids0, u_centre0, parent.xyz, direction);
  bool fromSecond = false;
  // 4
  if (!answer.isSure && u_cubeCount > 1) {
    Answer other = follow(u_position1, u_ids1, u_centre1, parent.xyz, direction);
    if (other.isSure || other.t < answer.t) {
      answer = other;
      fromSecond = true;
    }
  }
  if (answer.object == 0u) discard;
  vec3 radiance = fromSecond ? textureLod(u_color1, answer.direction, 0.0f).rgb
                             : textureLod(u_color0, answer.direction, 0.0f).rgb;
  o_radiance = vec4(radiance, 0.0f);
  o_position = vec4(parent.xyz + answer.t * direction, parent.w + answer.t);
  o_weight = vec4(0.0f);
  o_ids = uvec2(answer.object, u_chain << 16u);
}
