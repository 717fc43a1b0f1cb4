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

const float kSkyPath = 1.0e30f;
const uint kInsideBit = 0x40000000u;
const uint kUnfollowedBit = 0x20000000u;  // ids.r alone: the environment, in a mirror that no method draws

vec2 octahedralFromDirection(vec3 d) {
  vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
  vec2 signs = vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
  return d.z < 0.0f ? (vec2(1.0f) - abs(p.yx)) * signs : p;
}

vec3 directionFromOctahedral(vec2 p) {
  vec3 d = vec3(p, 1.0f - abs(p.x) - abs(p.y));
  vec2 signs = vec2(p.x < 0.0f ? -1.0f : 1.0f, p.y < 0.0f ? -1.0f : 1.0f);
  if (d.z < 0.0f) d = vec3((vec2(1.0f) - abs(d.yx)) * signs, d.z);
  return normalize(d);
}

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
