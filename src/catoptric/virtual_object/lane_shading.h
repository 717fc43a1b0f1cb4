// SPDX-License-Identifier: Apache-2.0
// virtual_shade.frag by the processor, where GL is software: shades, once at each pixel of a mirror, the
// triangle that is seen there, and adds it to the picture.
//
// In:  the level before, read back where the mirror is; the triangle of each pixel (NumberImage).
// Out: the level before with what the mirror shows, or the next level's images.
// Steps:
//   1. Pixels are sorted by the part that is seen there, band by band.
//   2. Eight pixels of a part at a time: the shaders' functions in lanes (lane_shader.h).
// Why: a software GL shades such pixels four to eight at a time as well, but reads every texel, vertex and
// uniform through general code.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/virtual_object/scene_triangles.h"

namespace catoptric::virtual_object {

class LaneShading {
 public:
  /// Reads what shade() needs of the level before; `bounds`: of the mirror.
  void readParent(const raster::Level& parent, const gl::Scissor& bounds);
  /// Points on the mirror, row by row of the bounds; w: length of the path to them.
  [[nodiscard]] std::span<const vec4> positions() const { return positions_; }

  /// Triangle + 1 at each pixel of the bounds, 0: none; bits of the distance to it.
  struct Hits {
    std::span<const uvec2> hits;
    bool fromEye;  ///< is it the length of the path from the eye, or from the mirror?
  };
  /// Adds to frame.addsTo, or writes `target`, at the pixels of the chain's mirror.
  void shade(raster::FrameContext& frame, const raster::Chain& chain, const SceneTriangles& triangles,
             const Hits& hits, raster::Level& target);

  /// Pixels of one part; `part` is the number of parts where nothing but the environment is seen.
  struct Run {
    std::uint32_t part, first, count;
  };
  /// Some rows, and their pixels of the mirror sorted by part: x | y << 16 within the bounds.
  struct Band {
    std::vector<std::uint32_t> counts, partsSeen, pixels;
    std::vector<Run> runs;
  };
  /// What all bands share.
  struct Job {
    raster::FrameContext& frame;
    const raster::Chain& chain;
    const SceneTriangles& triangles;
    const Hits& hits;
    LaneShading& images;
    bool isLast;
    bool hasSolids;  ///< light may be absorbed on its way
    const raster::LaneEnvironment& environment;
    std::vector<vec4> lights;
  };

 private:
  friend struct ShadeBand;
  void sortPixels(const Job& job, std::size_t begin, std::size_t end, Band& band) const;
  void readTarget(const raster::Level& target);
  void writeTarget(raster::Level& target);

  gl::Scissor bounds_;
  std::vector<vec4> positions_, radiances_, weights_;  ///< of the level before
  std::vector<vec4> nextRadiances_, nextPositions_, nextWeights_;
  std::vector<uvec2> nextIds_;
  std::vector<Band> bands_;
};

}  // namespace catoptric::virtual_object
