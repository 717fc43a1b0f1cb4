// SPDX-License-Identifier: Apache-2.0
// What shading takes that is the same at all fragments of a draw: a material's constants, as raster/scene_buffers.cpp:
// MaterialBlock packs them, those of the part that has it, lights and irradiance. Define LIGHTS: how many lights there are.

layout(std140) uniform Material {
  vec4 m_baseColor;
  vec4 m_emissive;        // w: metallic
  vec4 m_factors;         // roughness, normal scale, occlusion strength, alpha cutoff
  vec4 m_more;            // dielectric F0, 1 if unlit, 1 if alpha mask, 1 if double-sided
  vec4 m_uvRows[10];      // per slot two rows of uvFromMesh; w: uv set (first row), last mip level or -1 (second row)
};

uniform vec4 u_lobes;     // of a reflector: reflectivity, clearcoat, index of refraction (0 = no refractor); transmission
#ifndef LIGHTS
#define LIGHTS 16
#endif
#if LIGHTS > 0
uniform vec4 u_lights[4 * LIGHTS];  // color + kind, position + range, direction + cosInner, cosOuter
#endif
uniform vec3 u_irradiance[9];  // of the environment: spherical harmonics of irradiance / pi
uniform uint u_objectWord;     // (object + 1) | shell << 31
uniform uint u_reflectorWord;  // (reflector + 1) | chain << 16
