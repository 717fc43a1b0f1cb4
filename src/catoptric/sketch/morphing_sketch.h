// SPDX-License-Identifier: Apache-2.0
// What reflection morphing works with (Martin & Popescu 2004), to look at: the rays of a camera behind
// mirrors, a sampling cell and what its corners know of a vertex, a ray octree, the reflection mesh. World
// space.
#pragma once

#include <array>
#include <memory>

#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/reflection_morphing/location_source.h"
#include "catoptric/reflection_morphing/morphing.h"
#include "catoptric/sketch/sketch.h"

namespace catoptric::sketch {

/// Figure 3: of `count` pixels of the picture's middle row, the way over at most `bounces` mirrors, a colour
/// for each bounce (grey, red, blue, green, ...), the last piece up to the first thing or out of `bounds`.
/// `rays` must know obstacles.
[[nodiscard]] Sketch sketchCameraRays(const reflection_morphing::MirrorRays& rays,
                                      const scene::CameraFrame& camera, int count, int bounces);

/// The cell of the grid in which the eye is, loaded.
struct LoadedCell {
  reflection_morphing::SamplingCell cell;
  std::array<std::shared_ptr<const reflection_morphing::SamplingLocation>, 8> locations;

  [[nodiscard]] reflection_morphing::CellTrace findTrace(const reflection_morphing::Trace& trace) const;
};

/// Throws core::Error("sketch.outside") if the eye is not in the grid.
[[nodiscard]] LoadedCell loadCell(const reflection_morphing::LocationSource& source, const dvec3& eye);

/// Figures 5 and 7: the cell's box, from each corner (orange) the view ray to its mirror point and on to the
/// vertex, the interpolated mirror point (black) and where the vertex is drawn (blue).
[[nodiscard]] Sketch sketchMorphedVertex(const LoadedCell& loaded, const reflection_morphing::Trace& trace,
                                         const dvec3& eye, const dvec3& vertex);

/// Section 4.2: boxes of the leaves that hold a ray of the trace, the leaf of `point` red, its rays drawn
/// from the mirror into the leaf.
[[nodiscard]] Sketch sketchRayOctree(const reflection_morphing::SampledTrace& trace, const dvec3& point);

/// Figure 6: the triangles of `objects` as morphing draws them for an eye in the cell.
[[nodiscard]] Sketch sketchReflectionMesh(const LoadedCell& loaded, const reflection_morphing::Trace& trace,
                                          const dvec3& eye, const raster::TessellatedObjects& objects);

}  // namespace catoptric::sketch
