// SPDX-License-Identifier: Apache-2.0
// A mirror as a vertex shader reads it: triangles, explosion maps, hidden map, in textures that
// src/catoptric/virtual_object/mirror_textures.cpp fills. Frame: world axes, origin at the mirror's centre.

#include "lib/virtual_vertex.glsl"
#include "lib/mirror_law.glsl"

uniform usampler2DArray u_mapIds;        // a layer for each map: triangle * 2 + 1 for an extension polygon; kNoTriangle
uniform sampler2D u_mapTriangles;        // of each map's triangles 3 texels: u, v linear in coordinates; corners in the map
uniform sampler2D u_mirrorTriangles;     // 6 texels each: position0, edge1, edge2 with the Gram matrix, normal0..2
uniform usampler2D u_mirrorNeighbours;   // triangle * 4 + edge; flags
uniform usampler2D u_hiddenIds;          // what of the mirror the eye sees
uniform vec3 u_mapX, u_mapY, u_mapZ;     // axes of the maps
uniform vec3 u_mapLayers;                // 1 / near radius, layers per 1 / distance, last layer
uniform vec4 u_extensionCentres[16];     // of each map
uniform vec3 u_hiddenX, u_hiddenY, u_hiddenZ;
uniform vec4 u_hiddenPixels;             // lower corner, pixels per unit
uniform vec2 u_hiddenCone;               // nearest along the axis, squared cosine
uniform vec3 u_mirrorEye;                // the eye
uniform float u_mirrorRadius;
uniform int u_mirrorTriangleCount;
uniform int u_mirrorIsConvex;

const uint kNoTriangle = 0xffffffffu;

struct MirrorPoint {
  int triangle;  // -1: none
  vec2 uv;
  bool isPastBoundary;
};

vec4 readTable(sampler2D table, int index) {
  int width = textureSize(table, 0).x;
  return texelFetch(table, ivec2(index % width, index / width), 0);
}

uvec4 readNeighbours(int triangle) {
  int width = textureSize(u_mirrorNeighbours, 0).x;
  return texelFetch(u_mirrorNeighbours, ivec2(triangle % width, triangle / width), 0);
}

MirrorFacet readFacet(int triangle) {
  MirrorFacet t;
  t.position0 = readTable(u_mirrorTriangles, 6 * triangle).xyz;
  t.edge1 = readTable(u_mirrorTriangles, 6 * triangle + 1).xyz;
  t.edge2 = readTable(u_mirrorTriangles, 6 * triangle + 2).xyz;
  t.normal0 = readTable(u_mirrorTriangles, 6 * triangle + 3).xyz;
  t.normal1 = readTable(u_mirrorTriangles, 6 * triangle + 4).xyz;
  t.normal2 = readTable(u_mirrorTriangles, 6 * triangle + 5).xyz;
  return t;
}

bool isSkirt(int triangle) { return (readNeighbours(triangle).w & 1u) != 0u; }

vec3 positionOn(MirrorFacet t, vec2 uv) { return t.position0 + uv.x * t.edge1 + uv.y * t.edge2; }
vec3 normalOn(MirrorFacet t, vec2 uv) { return t.normal0 + uv.x * t.normal1 + uv.y * t.normal2; }

/// Foot of a point on a triangle's plane.
vec2 projectOnto(int triangle, vec3 point) {
  vec4 position0 = readTable(u_mirrorTriangles, 6 * triangle);
  vec4 edge1 = readTable(u_mirrorTriangles, 6 * triangle + 1), edge2 = readTable(u_mirrorTriangles, 6 * triangle + 2);
  return uvOfFoot(edge1.xyz, edge2.xyz, vec3(position0.w, edge1.w, edge2.w), point - position0.xyz);
}

uint mapIdAt(int layer, vec2 coords) {
  int count = textureSize(u_mapIds, 0).x;
  return texelFetch(u_mapIds, ivec3(mapPixelOf(coords.x, count), mapPixelOf(coords.y, count), layer), 0).x;
}

/// What one map says about a direction; lookUpMap() of explosion_map.h.
MirrorPoint lookUpMap(int layer, vec2 coords) {
  uint id = mapIdAt(layer, coords);
  for (int k = 1; k <= 4 && id == kNoTriangle; ++k)
    id = mapIdAt(layer, coords * (1.0f - float(k) / float(textureSize(u_mapIds, 0).x)));
  MirrorPoint at;
  at.triangle = id == kNoTriangle ? 0 : int(id >> 1u);
  at.uv = vec2(1.0f / 3.0f);
  at.isPastBoundary = true;
  if (id == kNoTriangle) return at;
  int texel = 3 * (layer * u_mirrorTriangleCount + at.triangle);
  vec4 a = readTable(u_mapTriangles, texel), b = readTable(u_mapTriangles, texel + 1), c = readTable(u_mapTriangles, texel + 2);
  if ((id & 1u) != 0u) {
    at.uv = uvOnOutline(b.zw, c.xy, c.zw, u_extensionCentres[layer].xy, coords);
    return at;
  }
  at.uv = uvFromMapCoords(a.xyz, vec3(a.w, b.xy), coords);
  at.isPastBoundary = isSkirt(at.triangle);
  return at;
}

/// Where the ray from the eye to the point meets the triangle that hides it: findHidingPoint() of the solver.
MirrorPoint findHidingPoint(vec3 point, bool surely) {
  MirrorPoint none;
  none.triangle = -1;
  vec3 toPoint = point - u_mirrorEye;
  float along = dot(toPoint, u_hiddenZ), squared = dot(toPoint, toPoint);
  if (!(along > u_hiddenCone.x) || along * along < u_hiddenCone.y * squared) return none;
  vec2 px = (mapCoordsOf(u_hiddenX, u_hiddenY, u_hiddenZ, toPoint * inversesqrt(squared)) - u_hiddenPixels.xy) * u_hiddenPixels.zw;
  int n = textureSize(u_hiddenIds, 0).x;
  if (!(min(px.x, px.y) >= 0.0f && max(px.x, px.y) <= float(n))) return none;
  ivec2 here = min(ivec2(px), ivec2(n - 1));
  uint id = texelFetch(u_hiddenIds, here, 0).x;
  bool isInside = id != kNoTriangle;
  for (int k = 0; k < 9; ++k) {  // at the outline a pixel is covered in part only
    ivec2 there = here + ivec2(k % 3 - 1, k / 3 - 1);
    bool isThere = min(there.x, there.y) >= 0 && max(there.x, there.y) < n;
    uint near = isThere ? texelFetch(u_hiddenIds, there, 0).x : kNoTriangle;
    isInside = isInside && near != kNoTriangle;
    if (id == kNoTriangle) id = near;
  }
  if (id == kNoTriangle || (surely && !isInside)) return none;
  MirrorFacet t = readFacet(int(id));
  vec3 facet = cross(t.edge1, t.edge2);
  float fraction = dot(facet, t.position0 - u_mirrorEye) / dot(facet, toPoint);
  if (!(fraction > 0.0f && fraction < 1.0f)) return none;
  MirrorPoint at;
  at.triangle = int(id);
  at.uv = clampUv(projectOnto(int(id), u_mirrorEye + fraction * toPoint));
  at.isPastBoundary = false;
  return at;
}
