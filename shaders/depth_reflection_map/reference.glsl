// SPDX-License-Identifier: Apache-2.0
// A reference image as a shader reads it. Coordinates are zexels from the lower left corner; zexel (x, y), disparity d
// shows the world point centre + worldFromZexel (x, y, 1) / d.
//
// A ray from p along r (world) is o + t s in the reference's own space, o = zexelFromWorld (p - centre), s =
// zexelFromWorld r; at t it is seen at (o + t s).xy / (o + t s).z, with the disparity 1 / (o + t s).z.

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
  const float kSurfaceStep = 0.06f;  // as in zexel_splats.cpp
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

/// Radiance at a position, blended between the neighbours that show the same object.
vec3 readZexelColor(sampler2D color, usampler2D zexels, vec2 position, uint object) {
  vec2 corner = position - vec2(0.5f);
  ivec2 base = ivec2(floor(corner)), last = textureSize(zexels, 0) - ivec2(1);
  vec2 f = corner - vec2(base);
  vec4 sum = vec4(0.0f);
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    ivec2 at = clamp(base + step, ivec2(0), last);
    float weight = (step.x == 1 ? f.x : 1.0f - f.x) * (step.y == 1 ? f.y : 1.0f - f.y);
    if (texelFetch(zexels, at, 0).y == object) sum += weight * vec4(texelFetch(color, at, 0).rgb, 1.0f);
  }
  return sum.w > 1.0e-6f ? sum.rgb / sum.w : texelFetch(color, clamp(ivec2(floor(position)), ivec2(0), last), 0).rgb;
}
