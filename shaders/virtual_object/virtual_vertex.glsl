// SPDX-License-Identifier: Apache-2.0
// Where a vertex shader draws a scene point so that it is seen in a curved mirror: the GPU's solvers `layered` and, by
// define, `explosion` (virtual_object_solver.cpp) and `refined` (virtual_search.glsl). Frame: that of mirror_maps.glsl.
// Defines: EXPLOSION = two maps, mirrored in the planes that they name; REFINED = the answer of the maps is polished.

#include "virtual_object/mirror_maps.glsl"

const int kNone = 0, kReflected = 1, kDoublyVirtual = 2, kPastBoundary = 3;  // raster::VertexKind

struct VirtualVertex {
  vec3 position;  // Q'
  vec3 onMirror;  // J
  int kind;
};

VirtualVertex makeVertex(vec3 position, vec3 onMirror, int kind) {
  VirtualVertex vertex;
  vertex.position = position;
  vertex.onMirror = onMirror;
  vertex.kind = kind;
  return vertex;
}

VirtualVertex makeNone(vec3 point) {
  return makeVertex(point, point, kNone);
}

VirtualVertex mirrorHidden(MirrorPoint at, vec3 point) {
  MirrorFacet t = readFacet(at.triangle);
  vec3 entry = positionOn(t, at.uv);
  return makeVertex(mirrorHiddenPoint(u_mirrorEye, entry, normalize(normalOn(t, at.uv)), point), entry,
                    kDoublyVirtual);
}

/// The two maps that a point lies between, and the blend of what they say: LayeredFinder::find().
struct MapBlend {
  MirrorPoint inner, outer;
  vec3 position, normal;
  float share;  // of the outer one
};

MapBlend lookUpMaps(vec3 point) {
  float distance = max(length(point), 1.0e-30f);
  vec2 coords = mapCoordsOf(u_mapX, u_mapY, u_mapZ, point / distance);
  float layer = mapLayerOf(distance, u_mapLayers.x, u_mapLayers.y, u_mapLayers.z);
  int lower = min(int(layer), int(u_mapLayers.z) - 1);
  MapBlend blend;
  blend.share = layer - float(lower);
  blend.inner = lookUpMap(lower, coords);
  blend.outer = lookUpMap(lower + 1, coords);
  MirrorFacet a = readFacet(blend.inner.triangle), b = readFacet(blend.outer.triangle);
  blend.position = mix(positionOn(a, blend.inner.uv), positionOn(b, blend.outer.uv), blend.share);
  blend.normal = normalize(mix(normalize(normalOn(a, blend.inner.uv)), normalize(normalOn(b, blend.outer.uv)), blend.share));
  return blend;
}

MirrorPoint heavierOf(MapBlend blend) {
  if (blend.share < 0.5f) return blend.inner;
  return blend.outer;
}

vec3 mirrorAt(MirrorPoint at, vec3 point) {
  MirrorFacet t = readFacet(at.triangle);
  return mirrorInPlane(point, positionOn(t, at.uv), normalOn(t, at.uv));
}

#ifdef REFINED
#include "virtual_object/virtual_search.glsl"
#endif

VirtualVertex findReflected(vec3 point) {
  MapBlend blend = lookUpMaps(point);
#if defined(EXPLOSION)
  MirrorPoint at = blend.share <= 0.5f ? blend.inner : blend.outer;
  vec3 position = mix(mirrorAt(blend.inner, point), mirrorAt(blend.outer, point), blend.share);
  return makeVertex(position, positionOn(readFacet(at.triangle), at.uv),
                    at.isPastBoundary ? kDoublyVirtual : kReflected);
#elif defined(REFINED)
  return searchVertex(blend, point);
#else
  vec3 onward = point - blend.position;
  if (dot(blend.normal, onward) <= 0.0f && length(onward) > 1.0e-6f * u_mirrorRadius) return makeNone(point);
  return makeVertex(placeBehind(u_mirrorEye, blend.position, point), blend.position,
                    heavierOf(blend).isPastBoundary ? kPastBoundary : kReflected);
#endif
}

VirtualVertex findVirtualVertex(vec3 point) {
#ifdef EXPLOSION
  bool asksFirst = true, surely = false;
#else
  bool asksFirst = u_mirrorIsConvex != 0, surely = true;
#endif
  MirrorPoint hiding;
  hiding.triangle = -1;
  if (asksFirst) hiding = findHidingPoint(point, surely);
  if (hiding.triangle >= 0) return mirrorHidden(hiding, point);
  VirtualVertex vertex = findReflected(point);
  if (vertex.kind == kNone) hiding = findHidingPoint(point, false);
  if (hiding.triangle >= 0) return mirrorHidden(hiding, point);
  return vertex;
}
