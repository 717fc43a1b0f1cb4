// SPDX-License-Identifier: Apache-2.0
// Which virtual triangles are worth drawing.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "catoptric/raster/tessellation.h"

namespace catoptric::raster {

/// None: nothing sensible exists, drop the vertex's triangles. DoublyVirtual: not reflected, but placed
/// outside the mirror's image (or in front of the mirror's surface, where the depth test against the mirror
/// removes it), so that it closes triangles that are partly reflected. PastBoundary: doubly virtual, and
/// where an open mirror that went on would reflect it, so that a triangle of such may lie across a corner of
/// the mirror, or between them and hidden ones show something within it.
enum class VertexKind : std::uint8_t { None, Reflected, DoublyVirtual, PastBoundary };

/// Indices into the TessellatedObjects' vertices; `parts` runs parallel to TessellatedObjects::parts
/// (firstVertex and vertexCount copied). Reused from frame to frame: nothing is allocated once the capacity
/// suffices.
struct VirtualTriangles {
  std::vector<std::uint32_t> indices;
  std::vector<TessellatedPart> parts;
  std::vector<std::uint8_t> isKept;  ///< by triangle of the TessellatedObjects
};

/// How far apart two reflection points of a triangle may be that is not reflected as a whole, metres: what
/// connects their images is drawn straight, and the mirror bends away from it.
struct LongestChords {
  /// Of one with a hidden corner and a reflected one, in a mirror without a boundary. It reaches around the
  /// reflector's shadow, and drawn it would cut off the rim along that chord, where what it may show is a
  /// ring much thinner than a pixel.
  float atRim = std::numeric_limits<float>::infinity();
  /// Of one with hidden corners and others past the mirror's boundary, none reflected.
  float atBoundary = std::numeric_limits<float>::infinity();
};

/// Drops triangles with a None vertex, those whose vertices are all DoublyVirtual, and those that are turned
/// inside out (their real face and their image do not have the mirrored orientation, which happens to
/// triangles that reach around the reflector's shadow; drawn, they would sweep across the mirror's image).
/// The winding is that of the real triangle, so seen from the eye it is reversed. `reflectionPoints`: J of
/// every vertex. `scenePoints`: where the vertices stand as the mirror sees them, if flat mirrors behind it
/// have moved them; empty for objects.positions.
void selectVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                            std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                            std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                            std::span<const vec3> scenePoints = {});

/// Clears `isKept` of those and of what has longer chords, by triangle of the objects; what it is clear of
/// already is not looked at.
void dropVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, std::span<std::uint8_t> isKept,
                          std::span<const vec3> scenePoints = {}, const LongestChords& longest = {});

/// Sets out.isKept alone: of all triangles, but for those.
void markVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                          std::span<const vec3> scenePoints = {}, const LongestChords& longest = {});

/// Fills the rest: the triangles of `out.isKept` with corners from `indices`, which run parallel to
/// objects.indices; only of the parts for which `isWanted` is set, of all if it is empty.
void gatherVirtualTriangles(const TessellatedObjects& objects, std::span<const std::uint32_t> indices,
                            std::span<const std::uint8_t> isWanted, VirtualTriangles& out);

}  // namespace catoptric::raster
