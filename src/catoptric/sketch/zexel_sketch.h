// SPDX-License-Identifier: Apache-2.0
// What depth-preserving reflection maps and environment maps work with (Bastos & Stuerzlinger 1998), to look
// at: texels on a reflection cell, zexels floating in space, exposures. World space.
#pragma once

#include <array>
#include <span>

#include "catoptric/core/seen.h"
#include "catoptric/depth_reflection_map/reference_file.h"
#include "catoptric/reflection_morphing/mirror_rays.h"
#include "catoptric/sketch/sketch.h"

namespace catoptric::sketch {

/// Cube faces of a traditional reflection map: +x, -x, +y, -y, +z, -z.
struct CubeFace {
  dvec3 forward{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};
};
[[nodiscard]] const std::array<CubeFace, 6>& cubeFaces();
/// A camera that takes such a face: 90 degrees, square.
[[nodiscard]] scene::Camera makeFaceCamera(const dvec3& centre, const CubeFace& face);

/// Figure 2: a cell of edge length `edge`, its texels with their colours, and the solid angles of one row of
/// texels as lines of `reach` world units. `faces` are square pictures taken with makeFaceCamera(); the top
/// is left open.
[[nodiscard]] Sketch sketchReflectionCell(const dvec3& centre, double edge, double reach,
                                          const std::array<core::ImageRgba8, 6>& faces);

/// Figure 3: of `count` pixels that show a mirror, evenly along the picture's middle row: the view ray
/// (green), the reflected ray up to what it really meets (black), and the ray in the same direction from the
/// middle of the cell up to what the map shows instead (red). `rays` must know obstacles.
[[nodiscard]] Sketch sketchMappedRays(const reflection_morphing::MirrorRays& rays,
                                      const scene::CameraFrame& camera, const dvec3& cellCentre, int count);

/// Figure 4: every `step`th zexel each way as a dot where it is in space, with its colour; the reference's
/// centre of projection and its image plane (the mirror).
[[nodiscard]] Sketch sketchZexels(const depth_reflection_map::StoredImage& image, int step);

/// Figure 5: `picture` with the mirror pixels that no zexel reached in magenta: `seen`, drawn without filling
/// them, has the sky where `truth` has a surface. Returns how many.
std::size_t markExposures(const core::SeenImage& seen, const core::SeenImage& truth,
                          core::ImageRgba8& picture);

}  // namespace catoptric::sketch
