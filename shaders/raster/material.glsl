// SPDX-License-Identifier: Apache-2.0
// Reads a material's textures at a fragment. TEXTURES, set by the host, says in its bits which of the five there are. The block mirrors raster/scene_buffers.cpp: MaterialBlock.

layout(std140) uniform Material {
  vec4 m_baseColor;
  vec4 m_emissive;        // w: metallic
  vec4 m_factors;         // roughness, normal scale, occlusion strength, alpha cutoff
  vec4 m_more;            // dielectric F0, 1 if unlit, 1 if alpha mask, 1 if double-sided
  vec4 m_uvRows[10];      // per slot two rows of uvFromMesh; w: uv set (first row), last mip level or -1 (second row)
};

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

vec2 slotUv(int slot, vec2 uv0, vec2 uv1) {
  vec2 uv = m_uvRows[2 * slot].w > 0.5f ? uv1 : uv0;
  return vec2(dot(m_uvRows[2 * slot].xyz, vec3(uv, 1.0f)), dot(m_uvRows[2 * slot + 1].xyz, vec3(uv, 1.0f)));
}

/// How slotUv() changes where the mesh's coordinates change by d0 and d1.
vec2 slotUvChange(int slot, vec2 d0, vec2 d1) {
  vec2 d = m_uvRows[2 * slot].w > 0.5f ? d1 : d0;
  return vec2(dot(m_uvRows[2 * slot].xy, d), dot(m_uvRows[2 * slot + 1].xy, d));
}

/// The rule of lib/texture_lod.glsl: blend two integer levels.
vec4 sampleSlot(sampler2D map, int slot, vec2 uv, vec2 dx, vec2 dy) {
  vec2 size = vec2(textureSize(map, 0));
  float lod = textureLodFromDerivatives(dx * size, dy * size, m_uvRows[2 * slot + 1].w);
  float lower = floor(lod);
  vec4 fine = textureLod(map, uv, lower);
  if (lod == lower) return fine;
  return mix(fine, textureLod(map, uv, lower + 1.0f), lod - lower);
}
