// SPDX-License-Identifier: Apache-2.0
// Question: what does each pixel of a curved mirror show, when the scene is known as points seen from a few
// centres (inverse warping: McMillan 1997; the future work of Bastos & Stuerzlinger 1998)?
//
// Inputs: a chain whose last mirror may be of any shape, with position and mirrored ray of its pixels in the
// parent level. Output: radiance, seen point and object into the target level, on the GPU.
//   1. Centres of a reflector: the middle of a closed one; for an open one a little before its middle. Others
//      lie around it at about its radius, one along each axis. The rays of a concave mirror meet before it,
//      in the eye's image: from there everything is seen as they see it, so the first centre is there, on a
//      grid.
//   2. The second cube, of the centre nearest to the eye, is asked where the first is unsure because a ray
//      went behind a silhouette.
//   3. shaders/depth_reflection_map/inverse_warp.frag follows the rays.
// Departures: no occlusion-compatible order is needed, since each pixel finds its own first crossing; cubes
// hold distances from the centre instead of depths along an axis.
// Known failures: what neither cube saw; things thinner than a step (1.5 texels) may be stepped over, and
// mirrors in the picture show the environment only. Cost: pixels times steps, independent of the scene's
// polygons; six pictures of the scene for each cube, once.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "catoptric/depth_reflection_map/zexel_options.h"
#include "catoptric/raster/scene_cube.h"

namespace catoptric::depth_reflection_map {

/// What the centres of a reflector's cubes are found from; stays as it is until something moves.
struct ReflectorOutline {
  dvec3 middle{0}, normal{0};                    ///< means over the vertices
  std::vector<std::pair<dvec3, dvec3>> samples;  ///< position and normal
};

[[nodiscard]] ReflectorOutline measureOutline(const scene::WorldGeometry& world, std::uint32_t reflector);

/// The point that the mirrored rays of the samples come nearest to (least squares); nothing where they are
/// parallel.
[[nodiscard]] std::optional<dvec3> findEyeImage(const ReflectorOutline& outline, const dvec3& eye);

/// Centres of a reflector's cubes, the first one first. `eye` decides which side of a double-sided one is
/// meant.
[[nodiscard]] std::vector<dvec3> makeCubeCentres(const scene::Reflector& mirror,
                                                 const ReflectorOutline& outline, const dvec3& eye);

class InverseWarp {
 public:
  InverseWarp();
  void setOptions(const ZexelOptions& options);
  void geometryChanged() {
    cubes_.geometryChanged();
    outlines_.clear();
  }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              const raster::Level& target);

 private:
  gl::Program program_;
  gl::VertexArray nothing_;
  raster::SceneCubeCache cubes_;
  std::map<std::uint32_t, ReflectorOutline> outlines_;  ///< by reflector
  int references_ = 2;
  bool marksExposures_ = false;
};

}  // namespace catoptric::depth_reflection_map
