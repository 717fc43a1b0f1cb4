// SPDX-License-Identifier: Apache-2.0
// Reads a material's textures at a fragment. TEXTURES, set by the host, says in its bits which of the five there are;
// COLORS and SECOND_UV, that vertices have colours and a second set of texture coordinates; ENVIRONMENT, that the part is a
// mirror and shows the environment.
// CATOPTRIC_LANES: the processor compiles this, eight pixels side by side (shaders/README.md), and has uniforms of its own.

#ifndef CATOPTRIC_LANES
#include "raster/material_block.glsl"

#ifdef FLAT_CONSTANTS  // see raster/hand_on_constants.glsl
flat in vec4 v_material[6];
flat in vec4 v_irradiance[7];
flat in vec4 v_lobes;
#define m_baseColor v_material[0]
#define m_emissive v_material[1]
#define m_factors v_material[2]
#define m_more v_material[3]
#define u_lobes v_lobes
#endif

uniform sampler2D u_baseColor;
uniform sampler2D u_metallicRoughness;
uniform sampler2D u_normalMap;
uniform sampler2D u_occlusion;
uniform sampler2D u_emissive;

#ifndef TEXTURES
#define TEXTURES 31
#endif

/// A constant: software rasterizers run both sides of an `if`, so that absent textures would be read like others.
bool hasTexture(int slot) { return ((TEXTURES >> slot) & 1) != 0; }

bool hasColors() {
#ifdef COLORS
  return true;
#else
  return false;
#endif
}

bool hasSecondUv() {
#ifdef SECOND_UV
  return true;
#else
  return false;
#endif
}

bool showsEnvironment() {
#ifdef ENVIRONMENT
  return true;
#else
  return false;
#endif
}

/// m_uvRows[i]
vec4 uvRow(int i) {
#ifdef FLAT_CONSTANTS
  if (i < 2) return v_material[4 + i];
#endif
  return m_uvRows[i];
}
#endif

CATOPTRIC_FN vec2 slotUv(int slot, vec2 uv0, vec2 uv1) {
  vec4 u = uvRow(2 * slot), v = uvRow(2 * slot + 1);
  vec2 uv = choose(u.w > 0.5f, uv1, uv0);
  return vec2(u.x * uv.x + u.y * uv.y + u.z, v.x * uv.x + v.y * uv.y + v.z);
}

/// How slotUv() changes where the mesh's coordinates change by d0 and d1.
CATOPTRIC_FN vec2 slotUvChange(int slot, vec2 d0, vec2 d1) {
  vec4 u = uvRow(2 * slot), v = uvRow(2 * slot + 1);
  vec2 d = choose(u.w > 0.5f, d1, d0);
  return vec2(u.x * d.x + u.y * d.y, v.x * d.x + v.y * d.y);
}

/// The rule of lib/texture_lod.glsl: blend two integer levels.
CATOPTRIC_FN vec4 sampleSlot(sampler2D map, int slot, vec2 uv, vec2 dx, vec2 dy) {
  vec2 size = vec2(textureSize(map, 0));
  float lod = textureLodFromDerivatives(dx * size, dy * size, uvRow(2 * slot + 1).w);
  float lower = floor(lod);
  vec4 fine = textureLod(map, uv, lower);
  if (anyLane(lod != lower)) fine = mix(fine, textureLod(map, uv, lower + 1.0f), lod - lower);
  return fine;
}
