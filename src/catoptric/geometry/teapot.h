// SPDX-License-Identifier: Apache-2.0
// The Utah teapot from its Bezier patches (Martin Newell 1975).
#pragma once

#include <span>

#include "catoptric/geometry/bezier_patch.h"

namespace catoptric::geometry {

enum class TeapotPart { All, Body, Handle, Spout, Lid };

struct TeapotOptions {
  int cellsPerPatch = 8;              ///< quads along each edge of a patch
  bool withBottom = true;             ///< the four patches that were added to Newell's 28
  TeapotPart part = TeapotPart::All;  ///< the bottom belongs to the body
};

/// The patches in Newell's units, z up, every one with its front (dS/du x dS/dv) outwards. The first 28 are
/// Newell's, the last four the bottom.
[[nodiscard]] std::span<const BicubicPatch> teapotPatches();

/// Stands on y = 0, the spout points to +x, 1 unit high from the table to the top of the knob (the body is
/// then about 1.27 wide, 2.05 from handle to spout). Vertices are shared where the surface is smooth.
[[nodiscard]] Mesh makeTeapot(const TeapotOptions& options = {});

}  // namespace catoptric::geometry
