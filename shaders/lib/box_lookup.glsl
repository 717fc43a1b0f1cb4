// SPDX-License-Identifier: Apache-2.0
// Parallax correction of an environment map by the box of the room (methods.md, section 4). World space. Real3 is vec3 in a
// shader and dvec3 in C++ (src/catoptric/environment_map/map_view.cpp), so that what is expected of a map and what is drawn
// have one text.

/// Direction from the map's centre in which the ray from p along d should look: to where it leaves the box.
CATOPTRIC_FN Real3 lookUpInBox(Real3 boxLower, Real3 boxUpper, Real3 centre, Real3 p, Real3 d) {
  Real least = Real(1.0e-9f);
  Real3 safe = Real3(abs(d.x) < least ? least : d.x, abs(d.y) < least ? least : d.y, abs(d.z) < least ? least : d.z);
  Real3 farPlanes = max((boxLower - p) / safe, (boxUpper - p) / safe);
  Real t = min(min(farPlanes.x, farPlanes.y), farPlanes.z);
  return t > Real(0.0f) ? normalize(p + t * d - centre) : d;
}
