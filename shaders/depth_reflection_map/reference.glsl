// SPDX-License-Identifier: Apache-2.0
// A reference image as a shader reads it. Coordinates are zexels from the lower left corner; zexel (x, y), disparity d
// shows the world point centre + worldFromZexel (x, y, 1) / d.
//
// A ray from p along r (world) is o + t s in the reference's own space, o = zexelFromWorld (p - centre), s =
// zexelFromWorld r; at t it is seen at (o + t s).xy / (o + t s).z, with the disparity 1 / (o + t s).z.

const float kSurfaceStep = 0.06f;  // as in zexel_landing.cpp

struct ZexelRay {
  vec3 o;
  vec3 s;
};

ZexelRay makeZexelRay(mat4 zexelFromWorld, vec3 centre, vec3 p, vec3 r) {
  ZexelRay ray;
  ray.o = mat3(zexelFromWorld) * (p - centre);
  ray.s = mat3(zexelFromWorld) * r;
  return ray;
}

float disparityOf(uvec2 zexel) { return uintBitsToFloat(zexel.x); }

/// Slope of the disparity at a zexel along an axis, from the neighbour on the same surface that it differs from least.
float disparitySlope(usampler2D zexels, ivec2 at, ivec2 axis, uvec2 here) {
  ivec2 last = textureSize(zexels, 0) - ivec2(1);
  uvec2 ahead = texelFetch(zexels, min(at + axis, last), 0).xy;
  uvec2 behind = texelFetch(zexels, max(at - axis, ivec2(0)), 0).xy;
  float d = disparityOf(here), limit = kSurfaceStep * d;
  float forwards = disparityOf(ahead) - d, backwards = d - disparityOf(behind);
  bool useAhead = ahead.y == here.y && abs(forwards) <= limit && at != min(at + axis, last);
  bool useBehind = behind.y == here.y && abs(backwards) <= limit && at != max(at - axis, ivec2(0));
  if (useAhead && useBehind) return abs(forwards) < abs(backwards) ? forwards : backwards;
  return useAhead ? forwards : (useBehind ? backwards : 0.0f);
}

/// Where the ray meets the plane that a zexel and its neighbours lie in: t, or -1. On a plane the disparity is linear in
/// the zexel coordinates: 1 / Z = d + g (x - z), which is linear in t.
float meetZexelPlane(ZexelRay ray, vec2 z, float d, vec2 g) {
  float a = d - dot(g, z);
  float slope = a * ray.s.z + dot(g, ray.s.xy);
  float t = (1.0f - a * ray.o.z - dot(g, ray.o.xy)) / slope;
  return abs(slope) > 1.0e-20f && t > 0.0f && ray.o.z + t * ray.s.z > 0.0f ? t : -1.0f;
}

vec2 zexelAt(ZexelRay ray, float t) {
  vec3 h = ray.o + t * ray.s;
  return h.xy / h.z;
}

/// What a ray is found to meet, near a zexel from which the search starts.
struct ZexelAnswer {
  float t;        // along the ray; negative where there is none, kSkyPath at the sky
  ivec2 at;       // the zexel in whose plane that is
  bool isSure;    // the ray meets the plane within the same surface
};

/// Follows the ray from zexel to zexel: cut with the plane of one, it goes through another. If that lies on the same
/// surface, the ray ends there; if it lies farther away, the ray has gone past an edge, and the search goes on from it; if
/// nearer, this image cannot tell. `reach`: how far, in zexels, a plane may be continued.
ZexelAnswer followZexels(usampler2D zexels, ZexelRay ray, ivec2 start, float reach) {
  ivec2 last = textureSize(zexels, 0) - ivec2(1), at = clamp(start, ivec2(0), last);
  ZexelAnswer answer = ZexelAnswer(-1.0f, at, false);
  bool isSame = false;
  for (int i = 0; i < 5; ++i) {
    uvec2 zexel = texelFetch(zexels, at, 0).xy;
    if (zexel.y == 0u) {  // the sky: at the end of the ray, if it is there too
      ivec2 end = clamp(ivec2(floor(ray.s.xy / ray.s.z)), ivec2(0), last);
      bool isSky = ray.s.z > 0.0f && texelFetch(zexels, end, 0).y == 0u;
      return isSky || i == 0 ? ZexelAnswer(kSkyPath, at, isSky) : answer;
    }
    vec2 z = vec2(at) + vec2(0.5f);
    vec2 g = vec2(disparitySlope(zexels, at, ivec2(1, 0), zexel), disparitySlope(zexels, at, ivec2(0, 1), zexel));
    float t = meetZexelPlane(ray, z, disparityOf(zexel), g);
    vec2 met = t > 0.0f ? zexelAt(ray, t) : z;
    if (t < 0.0f || any(greaterThan(abs(met - z), vec2(i == 0 ? reach : 32.0f)))) break;
    ivec2 next = clamp(ivec2(floor(met)), ivec2(0), last);
    if (i == 0 || isSame || next == at) answer = ZexelAnswer(t, at, isSame || next == at);
    if (answer.isSure) break;
    uvec2 other = texelFetch(zexels, next, 0).xy;
    float d = 1.0f / (ray.o.z + t * ray.s.z), difference = disparityOf(other) - d;
    isSame = other.y == zexel.y && abs(difference) <= kSurfaceStep * d;
    if (!isSame && difference > 0.0f) break;
    at = next;
  }
  return answer;
}

/// Radiance at a position, blended between the neighbours that show the same object; of zexel `at` if there are none.
vec3 readZexelColor(sampler2D color, usampler2D zexels, vec2 position, ivec2 zexel) {
  vec2 corner = position - vec2(0.5f);
  ivec2 base = ivec2(floor(corner)), last = textureSize(zexels, 0) - ivec2(1);
  vec2 f = corner - vec2(base);
  uint object = texelFetch(zexels, zexel, 0).y;
  vec4 sum = vec4(0.0f);
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 at = clamp(base + step, ivec2(0), last);
    float weight = (step.x == 1 ? f.x : 1.0f - f.x) * (step.y == 1 ? f.y : 1.0f - f.y);
    if (texelFetch(zexels, at, 0).y == object) sum += weight * vec4(texelFetch(color, at, 0).rgb, 1.0f);
  }
  return sum.w > 1.0e-6f ? sum.rgb / sum.w : texelFetch(color, zexel, 0).rgb;
}
