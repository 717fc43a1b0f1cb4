// SPDX-License-Identifier: Apache-2.0
// How a level of mirrors is stored, and how the level before is read. Four targets (the least ES 3.00 grants):
//   radiance    rgb: radiance without the mirror lobe      a: octahedral x of the mirror direction
//   position    rgb: world point                           a: length of the path from the eye
//   weight      rgb: what part of the mirrored radiance    a: octahedral y of the mirror direction
//   ids         r: (object + 1) | inside << 30 | shell << 31     g: (reflector + 1) | chain << 16
// A refractor's pixels are mirror pixels whose "mirror direction" is the refracted one; `inside` says that the ray in that
// direction goes through its solid.
// Composing adds what its mirrors show to a level's radiance. The last level has none of this: its mirrors show the
// environment and are stored like other surfaces.
// For the sky `position` holds the unit direction and kSkyPath, ids.r is 0. Where no mirror is, weight and both halves of
// the mirror direction say nothing, nor does position unless the level says what is seen.

CATOPTRIC_FN vec2 octahedralFromDirection(vec3 d) {
  vec2 p = vec2(d.x, d.y) / (abs(d.x) + abs(d.y) + abs(d.z));
  vec2 signs = vec2(choose(p.x < 0.0f, -1.0f, 1.0f), choose(p.y < 0.0f, -1.0f, 1.0f));
  return choose(d.z < 0.0f, vec2(1.0f - abs(p.y), 1.0f - abs(p.x)) * signs, p);
}

CATOPTRIC_FN vec3 directionFromOctahedral(vec2 p) {
  float z = 1.0f - abs(p.x) - abs(p.y);
  vec2 signs = vec2(choose(p.x < 0.0f, -1.0f, 1.0f), choose(p.y < 0.0f, -1.0f, 1.0f));
  vec2 xy = choose(z < 0.0f, vec2(1.0f - abs(p.y), 1.0f - abs(p.x)) * signs, p);
  return normalize(vec3(xy, z));
}

/// Distance at which a ray that leaves a mirror may begin to hit. The rule of the ray tracer: rounding of the origin to
/// float, with some room.
CATOPTRIC_FN float findRayBegin(vec3 origin) {
  return 1.0e-6f * max(abs(origin.x), max(abs(origin.y), abs(origin.z)));
}

#ifndef CATOPTRIC_LANES
const float kSkyPath = 1.0e30f;
const uint kInsideBit = 0x40000000u;
const uint kUnfollowedBit = 0x20000000u;  // ids.r alone: the environment, in a mirror that no method draws

uint reflectorOf(uvec2 ids) { return ids.y & 0xffffu; }  // + 1, 0 = none
uint chainOf(uvec2 ids) { return ids.y >> 16u; }

/// Mirror direction stored at a pixel of a level.
vec3 readMirrorDirection(sampler2D radiance, sampler2D weight, ivec2 pixel) {
  return directionFromOctahedral(vec2(texelFetch(radiance, pixel, 0).a, texelFetch(weight, pixel, 0).a));
}

/// Its change per pixel along one axis: difference to a neighbour on the same mirror, zero if there is none.
vec3 readMirrorDirectionStep(sampler2D radiance, sampler2D weight, usampler2D ids, ivec2 pixel, ivec2 axis, vec3 here) {
  ivec2 last = textureSize(ids, 0) - ivec2(1);
  uint key = texelFetch(ids, pixel, 0).y;
  ivec2 next = min(pixel + axis, last);
  if (next != pixel && texelFetch(ids, next, 0).y == key) return readMirrorDirection(radiance, weight, next) - here;
  next = max(pixel - axis, ivec2(0));
  if (next != pixel && texelFetch(ids, next, 0).y == key) return here - readMirrorDirection(radiance, weight, next);
  return vec3(0.0f);
}
#endif
