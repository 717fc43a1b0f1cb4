// SPDX-License-Identifier: Apache-2.0
// Question: what does each pixel of a curved mirror show, when the scene is known as points seen from a few
// centres (inverse warping: McMillan 1997; the future work of Bastos & Stuerzlinger 1998)?
//
// Inputs: a chain whose last mirror may be of any shape, with position and mirrored ray of its pixels in the
// parent level. Output: radiance, seen point and object into the target level, on the GPU.
//   1. Centres of a reflector: the middle of a closed one; for an open one a little before its middle. Others
//      lie around it at about its radius, one along each axis.
//   2. The first cube is that of the middle; the second, of the centre nearest to the eye, is asked where
//      the first is unsure because a ray went behind a silhouette.
//   3. shaders/depth_reflection_map/inverse_warp.frag follows the rays.
// Departures: no occlusion-compatible order is needed, since each pixel finds its own first crossing; cubes
// hold distances from the centre instead of depths along an axis.
// Known failures: what neither cube saw; things thinner than a step (2.5 texels) may be stepped over, and
// mirrors in the picture show the environment only. Cost: pixels times steps, independent of the scene's
// polygons; six pictures of the scene for each cube, once.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "catoptric/depth_reflection_map/zexel_options.h"
#include "catoptric/raster/scene_cube.h"

namespace catoptric::depth_reflection_map {

/// Centres of a reflector's cubes, the middle first. `eye` decides which side of a double-sided one is meant.
[[nodiscard]] std::vector<dvec3> makeCubeCentres(const scene::WorldGeometry& world, std::uint32_t reflector,
                                                 const dvec3& eye);

class InverseWarp {
 public:
  InverseWarp();
  void setOptions(const ZexelOptions& options);
  void geometryChanged() { cubes_.geometryChanged(); }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              const raster::Level& target);

 private:
  gl::Program program_;
  gl::VertexArray nothing_;
  raster::SceneCubeCache cubes_;
  int references_ = 2;
};

}  // namespace catoptric::depth_reflection_map
