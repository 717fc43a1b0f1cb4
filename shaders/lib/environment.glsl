// SPDX-License-Identifier: Apache-2.0
// Directions of the environment map and its irradiance. Compiled by C++ too.

/// Latitude-longitude coordinates of a unit direction: u = 0.5 looks along -z, v = 0 is straight up.
CATOPTRIC_FN vec2 latLongFromDirection(vec3 d) {
  float u = 0.5f + atan(d.x, -d.z) * 0.15915494309f;
  float v = acos(clamp(d.y, -1.0f, 1.0f)) * 0.31830988618f;
  return vec2(u, v);
}

/// Mip level at which one pixel, which spans `dx` and `dy` of the unit direction, covers about one texel of a map
/// that is `widthTexels` wide. Near the poles u runs fast but means little, so solid angle decides, not du.
CATOPTRIC_FN float environmentLod(vec3 dx, vec3 dy, float widthTexels) {
  float radiansPerPixel = sqrt(max(max(dot(dx, dx), dot(dy, dy)), 1.0e-12f));
  return max(log2(radiansPerPixel * widthTexels * 0.15915494309f), 0.0f);
}

/// Irradiance / pi at a unit normal from nine spherical-harmonic coefficients with the cosine lobe convolved in
/// (Ramamoorthi & Hanrahan 2001), never negative.
CATOPTRIC_FN vec3 evaluateIrradiance(vec3 c0, vec3 c1, vec3 c2, vec3 c3, vec3 c4, vec3 c5, vec3 c6, vec3 c7, vec3 c8,
                                     vec3 n) {
  vec3 sum = c0 * 0.282095f;
  sum += (c1 * n.y + c2 * n.z + c3 * n.x) * 0.488603f;
  sum += (c4 * (n.x * n.y) + c5 * (n.y * n.z) + c7 * (n.x * n.z)) * 1.092548f;
  sum += c6 * (0.315392f * (3.0f * n.z * n.z - 1.0f)) + c8 * (0.546274f * (n.x * n.x - n.y * n.y));
  return max(sum, vec3(0.0f));
}
