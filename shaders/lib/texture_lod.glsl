// SPDX-License-Identifier: Apache-2.0
// One rule for texture filtering, so that the rasterizer and the ray tracer blend the same two mip levels.
// Compiled by C++ too.

/// Mip level for texture coordinates that change by `dx` and `dy` (in texels of level 0) per pixel, 0..maxLod.
CATOPTRIC_FN float textureLodFromDerivatives(vec2 dx, vec2 dy, float maxLod) {
  float longest = max(dot(dx, dx), dot(dy, dy));
  return clamp(0.5f * log2(max(longest, 1.0e-12f)), 0.0f, maxLod);
}
