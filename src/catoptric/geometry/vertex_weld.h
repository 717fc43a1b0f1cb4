// SPDX-License-Identifier: Apache-2.0
// Which vertices of a mesh are the same corner of the surface, although a texture seam or a flat-shaded
// export stored them several times.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::geometry {

struct WeldOptions {
  double positionTolerance = 1e-6;  ///< per coordinate, in units of the positions; positive
  double normalTolerance = 1e-4;    ///< per component of the unit normal; ignored when no normals are given
};

/// For each vertex the lowest index of a vertex at the same place (and, where `normals` is not empty, with
/// the same normal). Every coordinate must be finite. Linear time whatever the input; the result depends on
/// the order of the vertices only.
[[nodiscard]] std::vector<std::uint32_t> weldVertices(std::span<const vec3> positions,
                                                      std::span<const vec3> normals,
                                                      const WeldOptions& options);

/// For each of `planes` the lowest index of a plane with the same normal and offset.
[[nodiscard]] std::vector<std::uint32_t> weldPlanes(std::span<const core::Plane> planes,
                                                    double normalTolerance, double offsetTolerance);

}  // namespace catoptric::geometry
