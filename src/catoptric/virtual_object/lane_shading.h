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

/// Triangle + 1 at each pixel of a mirror's bounds, row by row, 0: none; bits of the distance to it.
struct LaneHits {
  std::span<const uvec2> hits;
  bool fromEye;  ///< is it the length of the path from the eye, or from the mirror?
};

/// What the levels hold within a mirror's bounds, row by row.
struct LaneImages {
  gl::Scissor bounds;
  int levelWidthPx = 0;
  std::vector<vec4> positions, radiances, weights;  ///< of the level before; as large as the largest mirror
  std::vector<vec4> nextRadiances, nextPositions, nextWeights;  ///< of the next one; empty: not wanted
  std::vector<uvec2> nextIds;

  [[nodiscard]] std::size_t pixelCount() const {
    return std::size_t(bounds.width) * std::size_t(bounds.height);
  }
};

/// Some rows, and their pixels of the mirror sorted by the part that is seen there.
struct LaneBand {
  /// `part`: the number of parts where nothing but the environment is seen.
  struct Run {
    std::uint32_t part, first, count;
  };
  std::vector<Run> runs;
  std::vector<std::uint32_t> pixels;             ///< x | y << 16 within the bounds
  std::vector<std::uint32_t> counts, partsSeen;  ///< scratch
  std::vector<uvec2> found;                      ///< likewise: part and pixel, as they come
};

/// What all bands of a mirror share.
struct LaneJob {
  const raster::FrameContext& frame;
  const raster::Chain& chain;
  const SceneTriangles& triangles;
  const LaneHits& hits;
  LaneImages& images;
  const uvec2*
      ids;         ///< of the level before, at the first pixel of the bounds; rows are as long as the level's
  bool isLast;     ///< Level::isLast of the next level
  bool hasSolids;  ///< light may be absorbed on its way
  const raster::LaneEnvironment& environment;
  std::vector<vec4> lights;
};

/// Step 2. Adds to the radiances where frame.addsTo says so, else writes the next level's images.
void shadeBands(const LaneJob& job, std::span<const LaneBand> bands);

class LaneShading {
 public:
  /// Reads what shade() needs of the level before; `bounds`: of the mirror.
  void readParent(const raster::Level& parent, const gl::Scissor& bounds);
  /// Points on the mirror, row by row of the bounds; w: length of the path to them.
  [[nodiscard]] std::span<const vec4> positions() const {
    return std::span(images_.positions).first(images_.pixelCount());
  }

  /// What was read, and the bounds it is of.
  [[nodiscard]] const LaneImages& images() const { return images_; }

  /// Those and the directions in which rays go on, with the distance at which they may begin to hit, into
  /// images of the whole level, bottom row first.
  void writeRays(std::span<vec4> origins, std::span<vec4> directions) const;

  /// Adds to frame.addsTo, or writes `target`, at the pixels of the chain's mirror.
  void shade(raster::FrameContext& frame, const raster::Chain& chain, const SceneTriangles& triangles,
             const LaneHits& hits, raster::Level& target);

  /// The former without GL, so that several mirrors may be shaded beside each other, once the scene has made
  /// its laneEnvironment(): adds to the radiances that were read ...
  void add(const raster::FrameContext& frame, const raster::Chain& chain, const SceneTriangles& triangles,
           const LaneHits& hits);
  /// ... takes what has been added since at another mirror's pixels, where the bounds overlap ...
  void takeAdded(const LaneShading& other, std::span<const uvec2> parentIds, std::uint32_t otherWord);
  /// ... and puts all in its place.
  void writeAdded(raster::Level& level) const;

 private:
  LaneJob makeJob(const raster::FrameContext& frame, const raster::Chain& chain,
                  const SceneTriangles& triangles, const LaneHits& hits, bool isLast);
  void shade(const LaneJob& job);
  void readTarget(const raster::Level& target);
  void writeTarget(raster::Level& target);

  LaneImages images_;
  std::vector<LaneBand> bands_;
};

}  // namespace catoptric::virtual_object
