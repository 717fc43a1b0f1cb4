// SPDX-License-Identifier: Apache-2.0
// Shades a fragment of the scene in world space, seen directly (level 0) or as a virtual object through a chain of
// mirrors (level > 0).
// Defines, besides TEXTURES (see raster/material.glsl):
//   PARENT   level > 0: view rays start where the level before says
//   MASK     and only its pixels that show the mirror are drawn
//   CLIP     half spaces are cut off, by the vertex shader where the language has clip distances
//   MIRROR   a reflector: stores what the next level needs. Others, and those of the last level, store
//   SEEN     what is seen at this pixel, too
//   OVERLAY  blended surfaces: only premultiplied colour
//   ENVIRONMENT  a reflector of the last level: shows the environment
//   PLACED   virtual vertices were placed by the vertex shader, no triangle was left out

#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"
#include "raster/surface_shading.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv0;
in vec2 v_uv1;
in vec4 v_color;
in vec3 v_drawPosition;

uniform vec3 u_eye;               // level 0: where the view ray starts, world
uniform vec3 u_drawEye;           // the eye in draw space
uniform int u_windingFlipped;     // 1 where an odd number of mirrors turned the winding round

uniform uint u_parentWord;        // ids.g that a pixel of the level before must have
uniform vec4 u_clipPlanes[8];     // world: dot(xyz, p) + w >= 0 lies before the last planar mirror, ...
uniform sampler2D u_parentPosition;
uniform usampler2D u_parentIds;

layout(location = 0) out vec4 o_radiance;
#if defined(MIRROR)
layout(location = 1) out vec4 o_position;
layout(location = 2) out vec4 o_weight;
layout(location = 3) out uvec2 o_ids;
#elif !defined(OVERLAY)
layout(location = 1) out uvec2 o_ids;
#ifdef SEEN
layout(location = 2) out vec4 o_position;
#endif
#endif

#ifdef PLACED
#include "raster/placed_triangle.glsl"
#endif

/// False where this fragment cannot be seen through its chain; `from` is where the last view ray starts.
bool isSeenThroughChain(ivec2 pixel, float path, out vec3 from) {
  from = u_eye;
#ifdef MASK
  if (texelFetch(u_parentIds, pixel, 0).y != u_parentWord) return false;
#endif
#ifdef PARENT
  vec4 parent = texelFetch(u_parentPosition, pixel, 0);
  from = parent.xyz;
  if (dot(u_clipPlanes[0], vec4(v_position, 1.0f)) < 0.0f) return false;
  // The second z-buffer of 1998, section 3: nothing lies before the mirror that shows it.
  return path >= parent.w * 0.99999f;
#else
#if defined(CLIP) && defined(GL_ES)
  for (int i = 0; i < 8; ++i)
    if (dot(u_clipPlanes[i], vec4(v_position, 1.0f)) < 0.0f) return false;
#endif
  return true;
#endif
}

void main() {
  // Derivatives first: they are undefined after a fragment of the quad has left.
  SurfacePoint p;
  p.position = v_position;
  p.positionDx = dFdx(v_position);
  p.positionDy = dFdy(v_position);
  p.normal = v_normal;
  p.tangent = v_tangent;
  p.uv0 = v_uv0;
  p.uv0Dx = dFdx(v_uv0);
  p.uv0Dy = dFdy(v_uv0);
  p.uv1 = v_uv1;
  p.uv1Dx = dFdx(v_uv1);
  p.uv1Dy = dFdy(v_uv1);
  p.color = v_color;
  p.isFront = gl_FrontFacing != (u_windingFlipped != 0);

#ifdef ENVIRONMENT
  vec3 view = normalize(v_drawPosition - u_drawEye);  // flat mirrors turn it, but not how far it changes
  p.mirrorChange = vec2(boundMirrorChange(dFdx(view), v_normal, dFdx(v_normal)),
                        boundMirrorChange(dFdy(view), v_normal, dFdy(v_normal)));
#else
  p.mirrorChange = vec2(0.0f);
#endif
  float path = length(v_drawPosition - u_drawEye);
  vec3 from;
#ifdef PLACED
  if (!isWorthDrawing(p.positionDx, p.positionDy)) discard;
#endif
  if (!isSeenThroughChain(ivec2(gl_FragCoord.xy), path, from)) discard;
  if (!p.isFront && m_more.w < 0.5f) discard;
  p.toViewer = normalize(from - v_position);
  vec4 base = readBaseColor(p);
  if (isCutOut(base)) discard;

  ShadedPoint shaded = shadePoint(p, shadingNormal(p), base.rgb);
#if defined(OVERLAY)
  o_radiance = vec4(shaded.radiance * base.a, base.a);
#elif defined(MIRROR)
  vec2 oct = octahedralFromDirection(shaded.mirrorDirection);
  o_radiance = vec4(shaded.radiance, oct.x);
  o_position = vec4(v_position, path);
  o_weight = vec4(shaded.weight, oct.y);
  o_ids = uvec2(u_objectWord | (isInsideBehind(shaded, p.isFront, false) ? kInsideBit : 0u), u_reflectorWord);
#else
  o_radiance = vec4(shaded.radiance, 0.0f);
  o_ids = uvec2(u_objectWord, u_reflectorWord);
#ifdef SEEN
  o_position = vec4(v_position, path);
#endif
#endif
}
