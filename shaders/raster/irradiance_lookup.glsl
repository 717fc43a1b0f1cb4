// SPDX-License-Identifier: Apache-2.0
// The environment's irradiance, from constants of raster/material.glsl. Needs lib/environment.glsl.

/// The environment's irradiance / pi on a plane that faces a unit normal.
CATOPTRIC_FN vec3 lookUpIrradiance(vec3 n) {
#ifdef FLAT_CONSTANTS
  vec4 a = v_irradiance[0], b = v_irradiance[1], c = v_irradiance[2], d = v_irradiance[3], e = v_irradiance[4],
       f = v_irradiance[5], g = v_irradiance[6];
  return evaluateIrradiance(a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x), c.yzw, d.xyz, vec3(d.w, e.xy), vec3(e.zw, f.x),
                            f.yzw, g.xyz, n);
#else
  return evaluateIrradiance(u_irradiance[0], u_irradiance[1], u_irradiance[2], u_irradiance[3], u_irradiance[4],
                            u_irradiance[5], u_irradiance[6], u_irradiance[7], u_irradiance[8], n);
#endif
}
