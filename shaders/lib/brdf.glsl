// SPDX-License-Identifier: Apache-2.0
// The light that leaves a surface towards the eye, metallic-roughness model. World space, linear radiance.
// Compiled by C++ too: see shaders/README.md for what may be written here.

/// A surface point after its textures were read.
struct Surface {
  vec3 position;
  vec3 normal;       // unit, shading normal on the side of the viewer
  vec3 coatNormal;   // unit, of the clear coat: normal maps are those of what lies below it
  vec3 toViewer;     // unit
  vec3 baseColor;
  vec3 emissive;
  float metallic;
  float roughness;   // perceptual, 0..1
  float occlusion;   // 1 = open
  float f0Dielectric;
  float reflectivity;  // weight of the mirror lobe of a reflector; 0 for everything that is no reflector
  float clearcoat;     // weight of a clearcoat mirror lobe of a reflector
  float transmission;  // share of the light that a refractor lets through
  float eta;           // a refractor's index on the viewer's side over that on the other side; 0 = no refractor
};

/// KHR_lights_punctual. kind: 0 directional, 1 point, 2 spot.
struct PunctualLight {
  vec3 color;
  vec3 position;
  vec3 direction;    // unit, the way the light travels
  float range;       // 0 = unlimited
  float cosInner;
  float cosOuter;
  int kind;
};

/// Schlick 1994.
CATOPTRIC_FN vec3 fresnelSchlick(vec3 f0, float cosTheta) {
  float m = 1.0f - clamp(cosTheta, 0.0f, 1.0f);
  float m2 = m * m;
  return f0 + (vec3(1.0f) - f0) * (m2 * m2 * m);
}

/// Reflectance at normal incidence: base colour for metals, the dielectric constant otherwise.
CATOPTRIC_FN vec3 surfaceF0(Surface s) {
  return mix(vec3(s.f0Dielectric), s.baseColor, s.metallic);
}

/// What part of the mirrored radiance a reflector adds, per colour channel: tint, Schlick Fresnel, reflectivity.
CATOPTRIC_FN vec3 mirrorWeight(Surface s) {
  vec3 metal = fresnelSchlick(surfaceF0(s), dot(s.normal, s.toViewer)) * s.reflectivity;
  vec3 coat = fresnelSchlick(vec3(0.04f), dot(s.coatNormal, s.toViewer)) * s.clearcoat;
  return coat + (vec3(1.0f) - coat) * metal;
}

/// Irradiance of one light on a plane that faces `normal`, without occlusion (KHR_lights_punctual).
CATOPTRIC_FN vec3 lightIrradiance(PunctualLight light, Surface s, vec3 toLight, float distanceToLight) {
  float strength = max(dot(s.normal, toLight), 0.0f);
  if (light.kind != 0) {
    float falloff = 1.0f / max(distanceToLight * distanceToLight, 1.0e-6f);
    float q = choose(light.range > 0.0f, distanceToLight / light.range, 0.0f);
    falloff *= clamp(1.0f - q * q * q * q, 0.0f, 1.0f);
    strength *= falloff;
  }
  if (light.kind == 2) {
    float c = dot(light.direction, -toLight);
    float t = clamp((c - light.cosOuter) / max(light.cosInner - light.cosOuter, 1.0e-3f), 0.0f, 1.0f);
    strength *= t * t;
  }
  return light.color * strength;
}

/// Diffuse (Lambert) and GGX specular light from one punctual light. Reflectors get no highlight: the light has no
/// size, and its mirror image is a point.
CATOPTRIC_FN vec3 shadeLight(PunctualLight light, Surface s) {
  vec3 offset = light.position - s.position;
  float distanceToLight = max(length(offset), 1.0e-6f);
  vec3 toLight = light.kind == 0 ? -light.direction : offset / distanceToLight;
  vec3 irradiance = lightIrradiance(light, s, toLight, distanceToLight);
  vec3 f0 = surfaceF0(s);
  vec3 diffuseColor = s.baseColor * ((1.0f - s.metallic) * choose(s.eta > 0.0f, 1.0f - s.transmission, 1.0f));
  vec3 halfway = normalize(toLight + s.toViewer);
  float nl = max(dot(s.normal, toLight), 1.0e-4f);
  float nv = max(dot(s.normal, s.toViewer), 1.0e-4f);
  float nh = max(dot(s.normal, halfway), 0.0f);
  float alpha = max(s.roughness * s.roughness, 0.002f);
  float a2 = alpha * alpha;
  float d = nh * nh * (a2 - 1.0f) + 1.0f;
  float distribution = a2 / (3.14159265358979f * d * d);
  float visibility = 0.5f / (nl * sqrt(nv * nv * (1.0f - a2) + a2) + nv * sqrt(nl * nl * (1.0f - a2) + a2));
  vec3 fresnel = fresnelSchlick(f0, dot(s.toViewer, halfway));
  float hasHighlight = choose(s.reflectivity > 0.0f && s.metallic > 0.5f, 0.0f, 1.0f);
  vec3 specular = fresnel * (distribution * visibility * hasHighlight);
  return irradiance * ((vec3(1.0f) - fresnel) * diffuseColor / 3.14159265358979f + specular);
}

/// Split-sum approximation of the integrated GGX lobe: scale and bias of F0 (Karis 2014, mobile fit).
CATOPTRIC_FN vec2 environmentBrdf(float roughness, float cosTheta) {
  float rx = 1.0f - roughness;
  float ry = 0.0425f - 0.0275f * roughness;
  float rz = 1.04f - 0.572f * roughness;
  float rw = 0.022f * roughness - 0.04f;
  float a = min(rx * rx, exp2(-9.28f * cosTheta)) * rx + ry;
  return vec2(-1.04f * a + rz, 1.04f * a + rw);
}

/// Light from the environment and the surface itself. `irradiance` is irradiance / pi at the normal, `prefiltered`
/// the environment in the mirror direction blurred by the roughness. A reflector's mirror lobe is not in here:
/// it is mirrorWeight() times what the mirror shows.
CATOPTRIC_FN vec3 shadeAmbient(Surface s, vec3 irradiance, vec3 prefiltered) {
  vec3 f0 = surfaceF0(s);
  float cosTheta = clamp(dot(s.normal, s.toViewer), 0.0f, 1.0f);
  vec2 scaleBias = environmentBrdf(s.roughness, cosTheta);
  vec3 specularWeight = f0 * scaleBias.x + vec3(scaleBias.y);
  // What a refractor does not pass on.
  if (anyLane(s.eta > 0.0f)) specularWeight = choose(s.eta > 0.0f, fresnelSchlick(f0, cosTheta), specularWeight);
  float isReflector = choose(s.reflectivity > 0.0f, 1.0f, 0.0f);
  float opaque = choose(s.eta > 0.0f, 1.0f - s.transmission, 1.0f);
  vec3 diffuse = (vec3(1.0f) - specularWeight) * (s.baseColor * ((1.0f - s.metallic) * opaque)) * irradiance;
  vec3 specular = specularWeight * prefiltered * (1.0f - isReflector);
  return (diffuse + specular) * s.occlusion;
}

/// Sum of it all. `direct` is the sum of shadeLight() over the lights. For a reflector with reflectivity below one
/// the base shows through by the rest. From inside a refractor nothing but its own light is added: no lamp shines and no
/// environment is mirrored in there.
CATOPTRIC_FN vec3 shadeSurface(Surface s, vec3 direct, vec3 irradiance, vec3 prefiltered) {
  vec3 base = direct + shadeAmbient(s, irradiance, prefiltered);
  vec3 coat = fresnelSchlick(vec3(0.04f), dot(s.coatNormal, s.toViewer)) * s.clearcoat;
  base = base * (vec3(1.0f) - coat);
  // A half-silvered metal shows its base colour, lit as if it were paint, by 1 - reflectivity.
  float paint = choose(s.reflectivity > 0.0f, (1.0f - s.reflectivity) * s.metallic, 0.0f);
  vec3 reflected = base + s.baseColor * irradiance * (paint * s.occlusion);
  return s.emissive + choose(s.eta > 1.0f, vec3(0.0f), reflected);
}
