// SPDX-License-Identifier: Apache-2.0
// Shades a fragment of the scene in world space, seen directly (level 0) or as a virtual object through a chain of
// mirrors (level > 0), and stores what the next level needs.
// Defines: OVERLAY = blended surfaces; only premultiplied colour is written. TEXTURES: see raster/material.glsl.

#include "lib/brdf.glsl"
#include "lib/environment.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"

const int kMaxLights = 16;

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
in vec3 v_drawPosition;

uniform vec3 u_eye;               // level 0: where the view ray starts, world
uniform vec3 u_drawEye;           // the eye in draw space
uniform int u_windingFlipped;     // 1 where an odd number of mirrors turned the winding round
uniform uint u_objectWord;        // (object + 1) | shell << 31
uniform uint u_reflectorWord;     // (reflector + 1) | chain << 16
uniform float u_reflectivity;     // of the part, 0 for everything that is no reflector
uniform float u_clearcoat;
uniform int u_lightCount;
uniform vec4 u_lights[4 * kMaxLights];  // color+kind, position+range, direction+cosInner, cosOuter

uniform int u_hasParent;          // level > 0
uniform uint u_parentWord;        // ids.g that a pixel of the level before must have
uniform vec4 u_clipPlane;         // world: dot(xyz, p) + w >= 0 lies before the last planar mirror; zero = none
uniform sampler2D u_parentPosition;
uniform usampler2D u_parentIds;

#ifdef OVERLAY
layout(location = 0) out vec4 o_color;
#else
layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;
#endif

/// False where this fragment cannot be seen through its chain; `from` is where the last view ray starts.
bool isSeenThroughChain(ivec2 pixel, float path, out vec3 from) {
  from = u_eye;
  if (u_hasParent == 0) return true;
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) return false;
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  from = parent.xyz;
  if (dot(u_clipPlane.xyz, v_position) + u_clipPlane.w < 0.0f) return false;
  // The second z-buffer of 1998, section 3: nothing lies before the mirror that shows it.
  return path >= parent.w * 0.99999f;
}

vec3 shadingNormal(bool isFront, vec2 uv, vec2 dx, vec2 dy) {
  vec3 n = normalize(v_normal);
  if (hasTexture(2)) {
    vec3 t = v_tangent.xyz;
    float handedness = v_tangent.w;
    if (dot(t, t) < 1.0e-12f) {  // no tangents: from the change of texture coordinates over the triangle
      vec3 px = dFdx(v_position), py = dFdy(v_position);
      float determinant = dx.x * dy.y - dy.x * dx.y;
      t = (px * dy.y - py * dx.y) * (determinant < 0.0f ? -1.0f : 1.0f);
      vec3 b = (py * dx.x - px * dy.x) * (determinant < 0.0f ? -1.0f : 1.0f);
      t = t - n * dot(n, t);
      handedness = dot(cross(n, t), b) < 0.0f ? -1.0f : 1.0f;
    }
    if (dot(t, t) > 1.0e-30f) {
      t = normalize(t);
      vec3 b = cross(n, t) * handedness;
      vec3 c = sampleSlot(u_normalMap, 2, uv, dx, dy).xyz;
      vec3 m = normalize((2.0f * c - vec3(1.0f)) * vec3(m_factors.y, m_factors.y, 1.0f));
      n = normalize(t * m.x + b * m.y + n * m.z);
    }
  }
  return isFront ? n : -n;
}

PunctualLight readLight(int i) {
  PunctualLight light;
  light.color = u_lights[4 * i].xyz;
  light.kind = int(u_lights[4 * i].w);
  light.position = u_lights[4 * i + 1].xyz;
  light.range = u_lights[4 * i + 1].w;
  light.direction = u_lights[4 * i + 2].xyz;
  light.cosInner = u_lights[4 * i + 2].w;
  light.cosOuter = u_lights[4 * i + 3].x;
  return light;
}

void main() {
  // Derivatives first: they are undefined after a fragment of the quad has left.
  vec2 uvBase = slotUv(0, v_uv0, v_uv1), uvRough = slotUv(1, v_uv0, v_uv1), uvNormal = slotUv(2, v_uv0, v_uv1);
  vec2 uvOpen = slotUv(3, v_uv0, v_uv1), uvGlow = slotUv(4, v_uv0, v_uv1);
  vec2 baseDx = dFdx(uvBase), baseDy = dFdy(uvBase), roughDx = dFdx(uvRough), roughDy = dFdy(uvRough);
  vec2 normalDx = dFdx(uvNormal), normalDy = dFdy(uvNormal), openDx = dFdx(uvOpen), openDy = dFdy(uvOpen);
  vec2 glowDx = dFdx(uvGlow), glowDy = dFdy(uvGlow);
  bool isFront = gl_FrontFacing != (u_windingFlipped != 0);
  vec3 normal = shadingNormal(isFront, uvNormal, normalDx, normalDy);

  float path = length(v_drawPosition - u_drawEye);
  vec3 from;
  if (!isSeenThroughChain(ivec2(gl_FragCoord.xy), path, from)) discard;
  if (!isFront && m_more.w < 0.5f) discard;

  vec4 base = m_baseColor * v_color;
  if (hasTexture(0)) base *= sampleSlot(u_baseColor, 0, uvBase, baseDx, baseDy);
  if (m_more.z > 0.5f && base.a < m_factors.w) discard;

  Surface s;
  s.position = v_position;
  s.toViewer = normalize(from - v_position);
  s.normal = normal;
  s.baseColor = base.rgb;
  s.emissive = m_emissive.rgb;
  if (hasTexture(4)) s.emissive *= sampleSlot(u_emissive, 4, uvGlow, glowDx, glowDy).rgb;
  s.metallic = m_emissive.w;
  s.roughness = m_factors.x;
  if (hasTexture(1)) {
    vec4 texel = sampleSlot(u_metallicRoughness, 1, uvRough, roughDx, roughDy);
    s.roughness *= texel.g;
    s.metallic *= texel.b;
  }
  s.occlusion = 1.0f;
  if (hasTexture(3)) s.occlusion = mix(1.0f, sampleSlot(u_occlusion, 3, uvOpen, openDx, openDy).r, m_factors.z);
  s.f0Dielectric = m_more.x;
  s.reflectivity = u_reflectivity;
  s.clearcoat = u_clearcoat;

  vec3 mirrorDirection = reflect(-s.toViewer, s.normal);
  vec3 radiance = s.baseColor;  // unlit
  vec3 weight = vec3(0.0f);
  if (m_more.y < 0.5f) {
    vec3 direct = vec3(0.0f);
    for (int i = 0; i < u_lightCount; ++i) direct += shadeLight(readLight(i), s);
    vec3 prefiltered = s.reflectivity > 0.0f ? vec3(0.0f) : lookUpPrefiltered(mirrorDirection, s.roughness);
    radiance = shadeSurface(s, direct, lookUpIrradiance(s.normal), prefiltered);
    if ((u_reflectorWord & 0xffffu) != 0u) weight = mirrorWeight(s);
  }
#ifdef OVERLAY
  o_color = vec4(radiance * base.a, base.a);
#else
  vec2 oct = octahedralFromDirection(mirrorDirection);
  o_radiance = vec4(radiance, oct.x);
  o_position = vec4(v_position, path);
  o_weight = vec4(weight, oct.y);
  o_ids = uvec2(u_objectWord, u_reflectorWord);
#endif
}
