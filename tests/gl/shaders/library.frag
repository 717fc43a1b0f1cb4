// SPDX-License-Identifier: Apache-2.0
// Evaluates one function of shaders/lib for the inputs of the pixel's column. Rows of u_inputs, 4 floats each, are
// unpacked as in tests/gl/library_inputs.h; function numbers are those of its enumeration.

#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"

uniform sampler2D u_inputs;
uniform int u_function;
out vec4 o_value;

vec4 row(int i) { return texelFetch(u_inputs, ivec2(int(gl_FragCoord.x), i), 0); }

Surface readSurface() {
  Surface s;
  s.position = row(0).xyz;
  s.normal = row(1).xyz;
  s.toViewer = row(2).xyz;
  s.baseColor = row(3).xyz;
  s.emissive = row(4).xyz;
  s.metallic = row(0).w;
  s.roughness = row(1).w;
  s.occlusion = row(2).w;
  s.f0Dielectric = row(3).w;
  s.coatNormal = row(9).xyz;
  s.reflectivity = row(4).w;
  s.clearcoat = row(5).w;
  s.eta = row(8).w;
  s.transmission = row(10).w;
  return s;
}

PunctualLight readLight() {
  PunctualLight light;
  light.color = row(5).xyz;
  light.position = row(6).xyz;
  light.direction = row(7).xyz;
  light.kind = int(row(6).w);
  light.range = row(7).w;
  light.cosInner = row(8).x;
  light.cosOuter = row(8).y;
  return light;
}

void main() {
  Surface s = readSurface();
  PunctualLight light = readLight();
  vec3 a = row(9).xyz, b = row(10).xyz;
  vec3 value = vec3(0.0f);
  if (u_function == 0) value = fresnelSchlick(s.baseColor, row(8).z);
  else if (u_function == 1) value = surfaceF0(s);
  else if (u_function == 2) value = mirrorWeight(s);
  else if (u_function == 3) value = lightIrradiance(light, s, a, row(9).w);
  else if (u_function == 4) value = shadeLight(light, s);
  else if (u_function == 5) value = vec3(environmentBrdf(s.roughness, row(8).z), 0.0f);
  else if (u_function == 6) value = shadeAmbient(s, s.emissive, light.color);
  else if (u_function == 7) value = shadeSurface(s, light.color, s.emissive, b);
  else if (u_function == 8) value = vec3(latLongFromDirection(s.normal), 0.0f);
  else if (u_function == 9) value = vec3(environmentLod(a * 0.01f, b * 0.01f, 2048.0f));
  else if (u_function == 10)
    value = evaluateIrradiance(s.position, s.baseColor, s.emissive, light.color, light.position, a, b, light.direction,
                               s.toViewer, s.normal);
  else if (u_function == 11) value = vec3(textureLodFromDerivatives(row(9).xy * 30.0f, row(10).xy * 30.0f, 8.0f));
  else if (u_function == 12) value = vec3(relativeIndex(1.0f + row(10).w, a.x > 0.0f));
  else if (u_function == 13) value = refractionWeight(s);
  else if (u_function == 14) value = absorbLight(s.emissive, row(9).w);
  o_value = vec4(value, 1.0f);
}
