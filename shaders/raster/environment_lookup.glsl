// SPDX-License-Identifier: Apache-2.0
// Reads the environment map. Two integer levels are blended here, because drivers differ in how they round a level.

#ifndef CATOPTRIC_LANES  // see raster/material.glsl
uniform sampler2D u_environment;           // latitude-longitude radiance with mip levels
uniform sampler2DArray u_prefiltered;      // blurred by roughness, one layer each
uniform float u_environmentMaxLod;
uniform float u_prefilteredLast;           // index of the last layer
#endif

/// Radiance in a unit direction that changes by dx, dy per pixel.
CATOPTRIC_FN vec3 lookUpEnvironment(vec3 direction, vec3 dx, vec3 dy) {
  vec2 uv = latLongFromDirection(direction);
  float lod = min(environmentLod(dx, dy, float(textureSize(u_environment, 0).x)), u_environmentMaxLod);
  float lower = floor(lod);
  vec3 fine = vec3(textureLod(u_environment, uv, lower));
  if (anyLane(lod != lower)) fine = mix(fine, vec3(textureLod(u_environment, uv, lower + 1.0f)), lod - lower);
  return fine;
}

CATOPTRIC_FN vec3 lookUpPrefiltered(vec3 direction, float roughness) {
  vec2 uv = latLongFromDirection(direction);
#ifdef CATOPTRIC_LANES
  if (hasBlurred()) return readBlurred(uv);  // the two layers of the material's roughness, blended once
#endif
  float layer = clamp(roughness, 0.0f, 1.0f) * u_prefilteredLast;
  float lower = floor(layer);
  vec3 fine = vec3(textureLod(u_prefiltered, vec3(uv, lower), 0.0f));
  vec3 coarse = vec3(textureLod(u_prefiltered, vec3(uv, min(lower + 1.0f, u_prefilteredLast)), 0.0f));
  return mix(fine, coarse, layer - lower);
}
