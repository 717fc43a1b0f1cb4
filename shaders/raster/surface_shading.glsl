// SPDX-License-Identifier: Apache-2.0
// From a point of a surface, with how its attributes change per pixel, to the light that leaves it. World space. Shared
// by every pass that shades surfaces; the ray tracer has the same rules in reference/surface_shading.

#include "raster/irradiance_lookup.glsl"
#include "raster/lights.glsl"

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
  vec2 mirrorChange;      // how far the mirror direction turns, see boundMirrorChange(); where that shows the environment
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
CATOPTRIC_FN float boundMirrorChange(vec3 viewChange, vec3 normal, vec3 normalChange) {
  vec3 n = normalize(normal);
  return length(viewChange) + 2.0f * length(normalChange - n * dot(n, normalChange)) / max(length(normal), 1.0e-12f);
}

CATOPTRIC_FN vec4 readSlot(sampler2D map, int slot, SurfacePoint p) {
  return sampleSlot(map, slot, slotUv(slot, p.uv0, p.uv1), slotUvChange(slot, p.uv0Dx, p.uv1Dx),
                    slotUvChange(slot, p.uv0Dy, p.uv1Dy));
}

CATOPTRIC_FN vec4 readBaseColor(SurfacePoint p) {
  vec4 base = m_baseColor * p.color;
  if (hasTexture(0)) base = base * readSlot(u_baseColor, 0, p);
  return base;
}

/// Is this texel of an alpha-masked material cut out?
CATOPTRIC_FN bool isCutOut(vec4 base) { return m_more.z > 0.5f && base.w < m_factors.w; }

CATOPTRIC_FN vec3 shadingNormal(SurfacePoint p) {
  vec3 n = normalize(p.normal);
  if (hasTexture(2)) {
    vec3 t = vec3(p.tangent);
    float handedness = p.tangent.w;
    bool hasTangent = dot(t, t) >= 1.0e-12f;
    if (anyLane(!hasTangent)) {  // from the change of texture coordinates over the triangle
      vec2 dx = slotUvChange(2, p.uv0Dx, p.uv1Dx), dy = slotUvChange(2, p.uv0Dy, p.uv1Dy);
      float sign = choose(dx.x * dy.y - dy.x * dx.y < 0.0f, -1.0f, 1.0f);
      vec3 along = (p.positionDx * dy.y - p.positionDy * dx.y) * sign;
      vec3 b = (p.positionDy * dx.x - p.positionDx * dy.x) * sign;
      along = along - n * dot(n, along);
      t = choose(hasTangent, t, along);
      handedness = choose(hasTangent, handedness, choose(dot(cross(n, along), b) < 0.0f, -1.0f, 1.0f));
    }
    float square = dot(t, t);
    t = t / sqrt(max(square, 1.0e-30f));
    vec3 b = cross(n, t) * handedness;
    vec3 c = vec3(readSlot(u_normalMap, 2, p));
    vec3 m = normalize((2.0f * c - vec3(1.0f)) * vec3(m_factors.y, m_factors.y, 1.0f));
    n = choose(square > 1.0e-30f, normalize(t * m.x + b * m.y + n * m.z), n);
  }
  return n * choose(p.isFront, 1.0f, -1.0f);
}

/// Does the mirrored or refracted ray go on inside a refractor's solid? `wasInside`: so did the ray that met this point.
CATOPTRIC_FN bool isInsideBehind(ShadedPoint shaded, bool isFront, bool wasInside) {
  return u_lobes.z > 0.0f ? isFront != shaded.isTotal : wasInside;
}

CATOPTRIC_FN ShadedPoint shadePoint(SurfacePoint p, vec3 normal, vec3 baseColor) {
  Surface s;
  s.position = p.position;
  s.toViewer = p.toViewer;
  s.normal = normal;
  s.coatNormal = normal;
  if (hasTexture(2)) s.coatNormal = normalize(p.normal * choose(p.isFront, 1.0f, -1.0f));
  s.baseColor = baseColor;
  s.emissive = vec3(m_emissive);
  if (hasTexture(4)) s.emissive *= vec3(readSlot(u_emissive, 4, p));
  s.metallic = m_emissive.w;
  s.roughness = m_factors.x;
  if (hasTexture(1)) {
    vec4 texel = readSlot(u_metallicRoughness, 1, p);
    s.roughness *= texel.y;
    s.metallic *= texel.z;
  }
  s.occlusion = 1.0f;
  if (hasTexture(3)) s.occlusion = mix(1.0f, readSlot(u_occlusion, 3, p).x, m_factors.z);
  s.f0Dielectric = m_more.x;
  s.reflectivity = u_lobes.x;
  s.clearcoat = u_lobes.y;
  s.transmission = u_lobes.w;
  s.eta = u_lobes.z > 0.0f ? relativeIndex(u_lobes.z, p.isFront) : 0.0f;

  ShadedPoint shaded;
  shaded.isTotal = false;
  shaded.mirrorDirection = reflect(-s.toViewer, u_lobes.y > 0.0f ? s.coatNormal : s.normal);
  shaded.radiance = s.baseColor;  // unlit
  shaded.weight = vec3(0.0f);
  if (m_more.y > 0.5f) return shaded;
  vec3 direct = shadeLights(s);
  vec3 prefiltered = u_lobes.x > 0.0f ? vec3(0.0f) : lookUpPrefiltered(reflect(-s.toViewer, s.normal), s.roughness);
  shaded.radiance = shadeSurface(s, direct, lookUpIrradiance(s.normal), prefiltered);
  if ((u_reflectorWord & 0xffffu) != 0u) shaded.weight = u_lobes.z > 0.0f ? refractionWeight(s) : mirrorWeight(s);
  if (u_lobes.z > 0.0f) {
    vec3 refracted = refract(-s.toViewer, s.normal, s.eta);
    shaded.isTotal = dot(refracted, refracted) == 0.0f;
    shaded.mirrorDirection = choose(shaded.isTotal, shaded.mirrorDirection, refracted);
  }
  if (showsEnvironment())
    shaded.radiance += shaded.weight * lookUpEnvironment(shaded.mirrorDirection, vec3(p.mirrorChange.x, 0.0f, 0.0f),
                                                         vec3(0.0f, p.mirrorChange.y, 0.0f));
  return shaded;
}
