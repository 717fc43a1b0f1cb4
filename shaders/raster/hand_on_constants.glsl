// SPDX-License-Identifier: Apache-2.0
// Define FLAT_CONSTANTS (raster/surface_pass.h: addConstantsDefines()): a vertex shader hands constants on to its fragments in flat
// varyings. Mesa's llvmpipe fetches every component of a uniform for each pixel of its vectors, with bounds checks; a
// flat varying costs one load for all of them.

#include "raster/material_block.glsl"

flat out vec4 v_material[6];    // the block up to the first slot's rows
flat out vec4 v_irradiance[7];  // 27 components
flat out vec4 v_lobes;
#if LIGHTS > 0
flat out vec4 v_lights[8];      // the first two
#endif

void handOnConstants() {
  v_material[0] = m_baseColor;
  v_material[1] = m_emissive;
  v_material[2] = m_factors;
  v_material[3] = m_more;
  v_material[4] = m_uvRows[0];
  v_material[5] = m_uvRows[1];
  v_irradiance[0] = vec4(u_irradiance[0], u_irradiance[1].x);
  v_irradiance[1] = vec4(u_irradiance[1].yz, u_irradiance[2].xy);
  v_irradiance[2] = vec4(u_irradiance[2].z, u_irradiance[3]);
  v_irradiance[3] = vec4(u_irradiance[4], u_irradiance[5].x);
  v_irradiance[4] = vec4(u_irradiance[5].yz, u_irradiance[6].xy);
  v_irradiance[5] = vec4(u_irradiance[6].z, u_irradiance[7]);
  v_irradiance[6] = vec4(u_irradiance[8], 0.0f);
  v_lobes = u_lobes;
#if LIGHTS > 0
  for (int i = 0; i < 8; ++i) v_lights[i] = u_lights[min(i, 4 * LIGHTS - 1)];
#endif
}
