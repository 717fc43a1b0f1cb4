// SPDX-License-Identifier: Apache-2.0
// From a point of a surface, with how its attributes change per pixel, to the light that leaves it. World space. Shared
// by every pass that shades surfaces; the ray tracer has the same rules in reference/surface_shading.

#include "raster/irradiance_lookup.glsl"
#include "raster/lights.glsl"

uniform uint u_objectWord;        // (object + 1) | shell << 31
uniform uint u_reflectorWord;     // (reflector + 1) | chain << 16

/// A point to be shaded. Changes (Dx, Dy) are per pixel of the target.
struct SurfacePoint {
  vec3 position;
  vec3 positionDx, positionDy;
  vec3 normal;            // interpolated, on the front side
  vec4 tangent;           // w = handedness, zero if the mesh has none
  vec2 uv0, uv0Dx, uv0Dy;
  vec2 uv1, uv1Dx, uv1Dy;
  vec4 color;
  vec3 toViewer;          // unit
  bool isFront;
#ifdef ENVIRONMENT
  vec2 mirrorChange;      // how far the mirror direction turns, see boundMirrorChange()
#endif
};

/// What leaves it.
struct ShadedPoint {
  vec3 radiance;          // without the mirror lobe
  vec3 weight;            // what part of the mirrored (or refracted) radiance
  vec3 mirrorDirection;   // or, behind a refractor's surface, the refracted direction
  bool isTotal;           // totally reflected at a refractor's surface
};

/// Most that a mirror direction turns per pixel, radians: v - 2 (v n) n turns by what v turns and twice what n does, at most.
/// `normal` and its change need not be of unit length.
float boundMirrorChange(vec3 viewChange, vec3 normal, vec3 normalChange) {
  vec3 n = normalize(normal);
  return length(viewChange) + 2.0f * length(normalChange - n * dot(n, normalChange)) / max(length(normal), 1.0e-12f);
}

vec4 readSlot(sampler2D map, int slot, SurfacePoint p) {
  return sampleSlot(map, slot, slotUv(slot, p.uv0, p.uv1), slotUvChange(slot, p.uv0Dx, p.uv1Dx),
                    slotUvChange(slot, p.uv0Dy, p.uv1Dy));
}

vec4 readBaseColor(SurfacePoint p) {
  vec4 base = m_baseColor * p.color;
  return hasTexture(0) ? base * readSlot(u_baseColor, 0, p) : base;
}

/// Is this texel of an alpha-masked material cut out?
bool isCutOut(vec4 base) { return m_more.z > 0.5f && base.a < m_factors.w; }

vec3 shadingNormal(SurfacePoint p) {
  vec3 n = normalize(p.normal);
  if (hasTexture(2)) {
    vec3 t = p.tangent.xyz;
    float handedness = p.tangent.w;
    if (dot(t, t) < 1.0e-12f) {  // no tangents: from the change of texture coordinates over the triangle
      vec2 dx = slotUvChange(2, p.uv0Dx, p.uv1Dx), dy = slotUvChange(2, p.uv0Dy, p.uv1Dy);
      float determinant = dx.x * dy.y - dy.x * dx.y;
      t = (p.positionDx * dy.y - p.positionDy * dx.y) * (determinant < 0.0f ? -1.0f : 1.0f);
      vec3 b = (p.positionDy * dx.x - p.positionDx * dy.x) * (determinant < 0.0f ? -1.0f : 1.0f);
      t = t - n * dot(n, t);
      handedness = dot(cross(n, t), b) < 0.0f ? -1.0f : 1.0f;
    }
    if (dot(t, t) > 1.0e-30f) {
      t = normalize(t);
      vec3 b = cross(n, t) * handedness;
      vec3 c = readSlot(u_normalMap, 2, p).xyz;
      vec3 m = normalize((2.0f * c - vec3(1.0f)) * vec3(m_factors.y, m_factors.y, 1.0f));
      n = normalize(t * m.x + b * m.y + n * m.z);
    }
  }
  return p.isFront ? n : -n;
}

/// ids.r of a pixel whose mirrored or refracted ray goes on inside a refractor's solid. `wasInside`: so did the ray that
/// met this point.
uint objectWordBehind(ShadedPoint shaded, bool isFront, bool wasInside) {
  bool isInside = u_lobes.z > 0.0f ? isFront != shaded.isTotal : wasInside;
  return u_objectWord | (isInside ? kInsideBit : 0u);
}

ShadedPoint shadePoint(SurfacePoint p, vec3 normal, vec3 baseColor) {
  Surface s;
  s.position = p.position;
  s.toViewer = p.toViewer;
  s.normal = normal;
  s.coatNormal = normal;
  if (hasTexture(2)) s.coatNormal = normalize(p.isFront ? p.normal : -p.normal);
  s.baseColor = baseColor;
  s.emissive = m_emissive.rgb;
  if (hasTexture(4)) s.emissive *= readSlot(u_emissive, 4, p).rgb;
  s.metallic = m_emissive.w;
  s.roughness = m_factors.x;
  if (hasTexture(1)) {
    vec4 texel = readSlot(u_metallicRoughness, 1, p);
    s.roughness *= texel.g;
    s.metallic *= texel.b;
  }
  s.occlusion = 1.0f;
  if (hasTexture(3)) s.occlusion = mix(1.0f, readSlot(u_occlusion, 3, p).r, m_factors.z);
  s.f0Dielectric = m_more.x;
  s.reflectivity = u_lobes.x;
  s.clearcoat = u_lobes.y;
  s.transmission = u_lobes.w;
  s.eta = u_lobes.z > 0.0f ? relativeIndex(u_lobes.z, p.isFront) : 0.0f;

  ShadedPoint shaded;
  shaded.isTotal = false;
  shaded.mirrorDirection = reflect(-s.toViewer, s.clearcoat > 0.0f ? s.coatNormal : s.normal);
  shaded.radiance = s.baseColor;  // unlit
  shaded.weight = vec3(0.0f);
  if (m_more.y > 0.5f) return shaded;
  vec3 direct = shadeLights(s);
  vec3 prefiltered = s.reflectivity > 0.0f ? vec3(0.0f) : lookUpPrefiltered(reflect(-s.toViewer, s.normal), s.roughness);
  shaded.radiance = shadeSurface(s, direct, lookUpIrradiance(s.normal), prefiltered);
  if ((u_reflectorWord & 0xffffu) != 0u) shaded.weight = s.eta > 0.0f ? refractionWeight(s) : mirrorWeight(s);
  if (s.eta > 0.0f) {
    vec3 refracted = refract(-s.toViewer, s.normal, s.eta);
    shaded.isTotal = dot(refracted, refracted) == 0.0f;
    if (!shaded.isTotal) shaded.mirrorDirection = refracted;
  }
#ifdef ENVIRONMENT
  shaded.radiance += shaded.weight * lookUpEnvironment(shaded.mirrorDirection, vec3(p.mirrorChange.x, 0.0f, 0.0f),
                                                       vec3(0.0f, p.mirrorChange.y, 0.0f));
#endif
  return shaded;
}
