// SPDX-License-Identifier: Apache-2.0
// Reflected vertices of one trace for an eye inside a sampling cell (2004, section 6, MORPH_VERTEX).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/reflection_morphing/sampling_location.h"

namespace catoptric::reflection_morphing {

/// One trace at the eight locations of a cell; null where the trace is not seen from a location.
using CellTrace = std::array<const SampledTrace*, 8>;

/// Where a vertex is seen from the eight locations: mirror point, and the path from there to the vertex. It
/// holds as long as the eye stays in the cell and the vertex where it is.
struct CornerPoints {
  std::vector<std::array<vec4, 8>> points;
  std::vector<raster::VertexKind> kinds;
  std::vector<std::uint32_t> rim;  ///< memory of the look-up
};

/// Eight look-ups a vertex. Reflected: seen from at least one location. DoublyVirtual: not, but a triangle
/// (three `indices` each) has a corner there and another one that is reflected. None: all others, and all if
/// no location has the trace, or where the
/// locations see it at places that face different ways; their points mean nothing.
void lookUpCorners(const CellTrace& trace, std::span<const vec3> scenePoints,
                   std::span<const std::uint32_t> indices, CornerPoints& corners);

/// Weights of the locations that have the trace, made to add up to 1 again; all 0 if less than a quarter of
/// the weight has it.
[[nodiscard]] std::array<float, 8> weighTrace(const CellTrace& trace, const std::array<float, 8>& weights);

/// Interpolates the mirror points and pushes them along the view ray to the length of the path. Leaves what
/// is of kind None as it is.
void morphVertices(const vec3& eye, const std::array<float, 8>& weights, const CornerPoints& corners,
                   std::span<vec3> virtualPositions, std::span<vec3> mirrorPoints);

}  // namespace catoptric::reflection_morphing
