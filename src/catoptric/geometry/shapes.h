// SPDX-License-Identifier: Apache-2.0
// Simple solids and surfaces with exact normals. Metres, y up, centred on the origin unless said otherwise;
// every smooth part shares its vertices (texture seams excepted). Normals point outwards.
#pragma once

#include "catoptric/geometry/mesh.h"

namespace catoptric::geometry {

/// Sphere from an icosahedron whose edges are cut in `frequency` pieces: 20 frequency^2 well-shaped
/// triangles, about 5 frequency facets around, no poles, no texture coordinates. A convex polyhedron. For
/// mirrors.
[[nodiscard]] Mesh makeIcosphere(double radius, int frequency);

/// Sphere of latitude and longitude with texture coordinates.
[[nodiscard]] Mesh makeUvSphere(double radius, int segmentsAround, int rings);

/// The side of an upright cylinder. Without texture coordinates it closes on itself with shared vertices.
[[nodiscard]] Mesh makeCylinderSide(double radius, double height, int segmentsAround, int rows, bool withUv);

/// A flat disc at height y that faces up (or down).
[[nodiscard]] Mesh makeDisc(double radius, double y, int segmentsAround, bool facesUp);

/// Upright cylinder with caps and texture coordinates.
[[nodiscard]] Mesh makeCylinder(double radius, double height, int segmentsAround);

/// Upright cone or frustum with its base at y = 0, smooth side; a top radius of 0 gives a pointed cone whose
/// tip normals are those of the side. Caps if wanted. Texture: u around, v down the side.
[[nodiscard]] Mesh makeCone(double bottomRadius, double topRadius, double height, int segmentsAround,
                            bool capped);

/// Box with flat faces, each face with the whole texture (u to the right, v down, as seen from outside).
[[nodiscard]] Mesh makeBox(const dvec3& size);

/// Box with each face mapped in metres: one texture repeat is `metresPerRepeat` wide.
[[nodiscard]] Mesh makeBoxMetric(const dvec3& size, double metresPerRepeat);

/// Rectangle in the plane y = 0 that faces up, texture u along x, v along z, cells x cells quads.
[[nodiscard]] Mesh makePlane(double sizeX, double sizeZ, int cellsX, int cellsZ);

/// Rectangle with corners in counter-clockwise order seen from its front: (0,1) (1,1) (1,0) (0,0) of the
/// texture, that is lower left, lower right, upper right, upper left.
[[nodiscard]] Mesh makeQuad(const dvec3& lowerLeft, const dvec3& lowerRight, const dvec3& upperRight,
                            const dvec3& upperLeft);

/// Torus around the y axis.
[[nodiscard]] Mesh makeTorus(double majorRadius, double minorRadius, int segmentsAround, int segmentsTube);

/// A rod from a to b.
[[nodiscard]] Mesh makeRod(const dvec3& a, const dvec3& b, double radius, int segmentsAround);

/// Placement helpers: chains read targetFromMesh.
[[nodiscard]] dmat4 moveBy(const dvec3& offset);
[[nodiscard]] dmat4 turnAround(const dvec3& axis, double radians);
[[nodiscard]] dmat4 scaleBy(const dvec3& factors);

}  // namespace catoptric::geometry
