// SPDX-License-Identifier: Apache-2.0
// What virtual objects work with (Ofek & Rappoport 1998; Blythe 1999), to look at: maps of triangle ids,
// rays, a cell of the reflection subdivision, virtual vertices and triangles. World space.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/sketch/sketch.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::sketch {

/// A colour for each triangle. Of many triangles, which are a few pixels each in a map, neighbours have like
/// ones: by where on the mirror they lie, so that a place can be found again in another map.
[[nodiscard]] std::vector<Colour> colourTriangles(const virtual_object::ReflectorMesh& mesh);

/// The colour of each triangle, darker where an extension polygon of it stands in (if ids carry
/// virtual_object::kExtensionBit), black outside the circle.
[[nodiscard]] core::ImageRgba8 drawMap(const core::Image<std::uint32_t>& ids, bool hasExtensionBit,
                                       std::span<const Colour> colours);

/// Near, far and hidden map in a row.
[[nodiscard]] core::ImageRgba8 drawMaps(const virtual_object::VirtualObjectSolver& solver);

/// Of about `count` front-facing vertices, spread evenly over the mesh: view ray grey, reflected ray red,
/// hidden ray blue, the latter two `length` world units long.
[[nodiscard]] Sketch sketchRays(const virtual_object::ReflectorMesh& mesh, const dvec3& eye, int count,
                                double length);

/// 1998, figure 10: the reflected cell of a triangle, its three ruled sides, and the hidden cell behind it.
/// Nothing where no corner of the triangle faces the eye.
[[nodiscard]] std::optional<Sketch> sketchCell(const virtual_object::ReflectorMesh& mesh, const dvec3& eye,
                                               std::uint32_t triangle, double length);

/// The mesh triangle whose J shows `point` to the eye of the solver.
[[nodiscard]] std::optional<std::uint32_t> findTriangleOf(const virtual_object::VirtualObjectSolver& solver,
                                                          const dvec3& point);

/// A scene point Q, J and Q': eye - J grey, J - Q red, J - Q' blue. Nothing where Q is not reflected.
[[nodiscard]] Sketch sketchReflectedPoint(const virtual_object::VirtualObjectSolver& solver,
                                          const dvec3& point);

/// Edges of virtual triangles, in the colour of their part, and their faces where `withFaces`.
[[nodiscard]] Sketch sketchVirtualTriangles(std::span<const vec3> virtualPositions,
                                            const raster::VirtualTriangles& triangles, bool withFaces);

}  // namespace catoptric::sketch
