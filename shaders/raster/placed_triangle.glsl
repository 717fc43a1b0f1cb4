// SPDX-License-Identifier: Apache-2.0
// Which fragments of virtual triangles are worth drawing where the vertex shader has placed the vertices: what
// raster/virtual_triangles.cpp decides for whole triangles, which a vertex shader does not see.

in vec3 v_towardsMirror;  // world axes: from the point to where the mirror shows it
in vec2 v_kinds;          // not 0: a corner is not there; 0: all are hidden

uniform float u_orientation;  // -1 where flat mirrors turn the picture round

/// False also where the triangle is turned inside out: a mirror reverses orientation, so that the side of the surface that
/// the screen seems to show is the one that looks away from the mirror.
bool isWorthDrawing(vec3 positionDx, vec3 positionDy) {
  if (v_kinds.x > 1.0e-4f || v_kinds.y < 1.0e-4f) return false;
  const float kEdgeOn = 0.02f;  // sine below which a face says nothing about its orientation
  vec3 normal = u_orientation * cross(positionDx, positionDy);
  return dot(normal, v_towardsMirror) <= kEdgeOn * length(normal) * length(v_towardsMirror);
}
