// SPDX-License-Identifier: Apache-2.0
// What goes through the surface of a solid. World space, linear radiance. The refracted direction itself is
// GLSL's refract().
// Compiled by C++ too: see shaders/README.md for what may be written here.

#include "lib/brdf.glsl"

/// Index of refraction on the viewer's side over that on the other side of a solid's surface.
CATOPTRIC_FN float relativeIndex(float ior, bool isFront) { return choose(isFront, 1.0f / ior, ior); }

/// What part of the radiance from behind its surface a refractor passes on, per colour channel: what Schlick's Fresnel
/// term does not send back, tinted. Schlick counts from the thinner side. All of it where reflection is total: then the
/// radiance is that of the mirror direction.
CATOPTRIC_FN vec3 refractionWeight(Surface s) {
  float cosTheta = dot(s.normal, s.toViewer);
  float square = 1.0f - s.eta * s.eta * (1.0f - cosTheta * cosTheta);
  float cosThinner = choose(s.eta > 1.0f, sqrt(max(square, 0.0f)), cosTheta);
  vec3 passed = (vec3(1.0f) - fresnelSchlick(vec3(s.f0Dielectric), cosThinner)) * s.baseColor * s.transmission;
  return choose(square < 0.0f, vec3(1.0f), passed);
}

/// What is left of light that went so far through a solid (Beer and Lambert).
CATOPTRIC_FN vec3 absorbLight(vec3 absorption, float way) {
  return exp(absorption * -way);
}
