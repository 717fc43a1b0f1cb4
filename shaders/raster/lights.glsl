// SPDX-License-Identifier: Apache-2.0
// What the scene's lights bring to a surface. Needs lib/brdf.glsl and raster/material_block.glsl.

#ifndef CATOPTRIC_LANES  // see raster/material.glsl
#if defined(FLAT_CONSTANTS) && LIGHTS > 0  // see raster/hand_on_constants.glsl
flat in vec4 v_lights[8];
#endif

PunctualLight unpackLight(vec4 a, vec4 b, vec4 c, float cosOuter) {
  PunctualLight light;
  light.color = a.xyz;
  light.kind = int(a.w);
  light.position = b.xyz;
  light.range = b.w;
  light.direction = c.xyz;
  light.cosInner = c.w;
  light.cosOuter = cosOuter;
  return light;
}

/// Sum over the lights; the first two come in flat varyings where constants do.
vec3 shadeLights(Surface s) {
  vec3 sum = vec3(0.0f);
#if defined(FLAT_CONSTANTS) && LIGHTS > 0
  sum += shadeLight(unpackLight(v_lights[0], v_lights[1], v_lights[2], v_lights[3].x), s);
#if LIGHTS > 1
  sum += shadeLight(unpackLight(v_lights[4], v_lights[5], v_lights[6], v_lights[7].x), s);
#endif
#define FIRST_LIGHT 2
#else
#define FIRST_LIGHT 0
#endif
#if LIGHTS > FIRST_LIGHT
  for (int i = FIRST_LIGHT; i < LIGHTS; ++i)
    sum += shadeLight(unpackLight(u_lights[4 * i], u_lights[4 * i + 1], u_lights[4 * i + 2], u_lights[4 * i + 3].x), s);
#endif
  return sum;
}
#endif
