// SPDX-License-Identifier: Apache-2.0
// The formulas of virtual vertices that look a mirror up in explosion maps: 1998, sections 3 and 4; 1999; corrections in
// src/catoptric/virtual_object/README.md. Any frame, the same for all points. Real is float in a shader and double in C++
// (src/catoptric/virtual_object/formulas.h), so that both backends have one text; Real2 and Real3 are vectors of it.

/// MapCoords with Blythe's factor: a unit direction to the disc of radius 1. x, y, z: the map's axes.
CATOPTRIC_FN Real2 mapCoordsOf(Real3 x, Real3 y, Real3 z, Real3 direction) {
  Real scale = Real(1.0f) / sqrt(max(Real(2.0f) * (dot(z, direction) + Real(1.0f)), Real(1.0e-12f)));
  return Real2(dot(x, direction) * scale, dot(y, direction) * scale);
}

/// Pixel of one map coordinate, of `count`.
CATOPTRIC_FN int mapPixelOf(Real coordinate, int count) {
  return clamp(int((coordinate + Real(1.0f)) * Real(0.5f) * Real(count)), 0, count - 1);
}

/// Between which maps a point lies at this distance from their centre: they are spaced evenly in 1 / distance. (Of two maps
/// it is one minus the near map's weight by relative distances.)
CATOPTRIC_FN Real mapLayerOf(Real distance, Real inverseNear, Real layersPerInverse, Real lastLayer) {
  return clamp((Real(1.0f) / distance - inverseNear) * layersPerInverse, Real(0.0f), lastLayer);
}

/// The paper's barycentrics (negative ones included), linear in map coordinates: u.x + u.y * x + u.z * y.
CATOPTRIC_FN Real2 uvFromMapCoords(Real3 u, Real3 v, Real2 coords) {
  return Real2(u.x + u.y * coords.x + u.z * coords.y, v.x + v.y * coords.x + v.z * coords.y);
}

/// Where the line through `centre` and `coords` meets the edge from a to b, and how far from `coords` (squared).
struct PlaceOnEdge {
  Real along;
  Real distance;
};

CATOPTRIC_FN PlaceOnEdge placeOnEdge(Real2 a, Real2 b, Real2 centre, Real2 coords) {
  Real2 direction = coords - centre;
  Real2 edge = b - a;
  Real denominator = direction.x * edge.y - direction.y * edge.x;
  PlaceOnEdge place;
  place.along = Real(0.5f);
  place.distance = Real(1.0e30f);
  if (abs(denominator) < Real(1.0e-15f)) return place;
  Real2 toStart = a - centre;
  place.along = clamp((toStart.x * direction.y - toStart.y * direction.x) / denominator, Real(0.0f), Real(1.0f));
  Real2 away = a + place.along * edge - coords;
  place.distance = dot(away, away);
  return place;
}

/// (u, v) of the point of a triangle's outline that lies on the radius through `coords`: what an extension polygon stands
/// for. a, b, c: its corners in the map; `centre`: where extension polygons lead away from.
CATOPTRIC_FN Real2 uvOnOutline(Real2 a, Real2 b, Real2 c, Real2 centre, Real2 coords) {
  PlaceOnEdge first = placeOnEdge(a, b, centre, coords);
  PlaceOnEdge second = placeOnEdge(b, c, centre, coords);
  PlaceOnEdge third = placeOnEdge(c, a, centre, coords);
  if (second.distance < first.distance && second.distance <= third.distance)
    return Real2(Real(1.0f) - second.along, second.along);
  if (third.distance < first.distance) return Real2(Real(0.0f), Real(1.0f) - third.along);
  return Real2(first.along, Real(0.0f));
}

CATOPTRIC_FN Real2 clampUv(Real2 uv) {
  Real2 inside = Real2(max(uv.x, Real(0.0f)), max(uv.y, Real(0.0f)));
  return inside * (Real(1.0f) / max(inside.x + inside.y, Real(1.0f)));
}

/// (u, v) of the foot of a point on a triangle's plane; `offset`: from its first corner; `gram`: 11, 12, 22 of the inverse of
/// the edges' Gram matrix.
CATOPTRIC_FN Real2 uvOfFoot(Real3 edge1, Real3 edge2, Real3 gram, Real3 offset) {
  Real a = dot(edge1, offset);
  Real b = dot(edge2, offset);
  return Real2(gram.x * a + gram.y * b, gram.y * a + gram.z * b);
}

/// Mirror image of a point in the plane through `onPlane`; the normal need not be unit.
CATOPTRIC_FN Real3 mirrorInPlane(Real3 point, Real3 onPlane, Real3 normal) {
  return point - normal * (Real(2.0f) * dot(point - onPlane, normal) / dot(normal, normal));
}

/// Q': on the ray eye -> J, at the distance |EJ| + |JQ|, so that depth order is the order of path length.
CATOPTRIC_FN Real3 placeBehind(Real3 eye, Real3 onMirror, Real3 point) {
  Real3 toMirror = onMirror - eye;
  Real3 onward = point - onMirror;
  return onMirror + toMirror * (sqrt(dot(onward, onward)) / sqrt(dot(toMirror, toMirror)));
}

/// Where a hidden point is drawn: mirrored in the tangent plane where the ray from the eye enters, but never farther than
/// half the eye's distance, which keeps it in front of the eye. `normal` is unit.
CATOPTRIC_FN Real3 mirrorHiddenPoint(Real3 eye, Real3 entry, Real3 normal, Real3 point) {
  Real3 behind = point - entry;
  Real3 toEye = eye - entry;
  Real depth = sqrt(dot(behind, behind));
  Real longest = Real(0.5f) * sqrt(dot(toEye, toEye));
  Real3 mirrored = behind - normal * (Real(2.0f) * dot(behind, normal));
  return entry + mirrored * (depth > longest ? longest / depth : Real(1.0f));
}
