// SPDX-License-Identifier: Apache-2.0
// Lines and points that show what a method works with, for an eye that looks on from elsewhere: the methods
// fill them from what they have of the last frame, the renderer draws them among the scene.
#pragma once

#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/buffer.h"
#include "catoptric/gl/program.h"
#include "catoptric/raster/level.h"
#include "catoptric/raster/mark_options.h"

namespace catoptric::raster {

struct Marks {
  /// World; two for each line, one for each point. Colours are linear.
  std::vector<vec3> linePositions, lineColors, pointPositions, pointColors;

  void addLine(const dvec3& from, const dvec3& to, const vec3& color) {
    linePositions.insert(linePositions.end(), {vec3(from), vec3(to)});
    lineColors.insert(lineColors.end(), {color, color});
  }
  void addPoint(const dvec3& at, const vec3& color) {
    pointPositions.emplace_back(at);
    pointColors.push_back(color);
  }
  /// The twelve edges.
  void addBox(const dvec3& lower, const dvec3& upper, const vec3& color);
};

class MarksPass {
 public:
  MarksPass();
  /// Into the level's plain target, with depth: nearer surfaces hide them.
  void draw(const Marks& marks, const dmat4& clipFromWorld, const Level& target);

 private:
  gl::Program program_;
  gl::Buffer positions_, colors_;
  gl::VertexArray array_;
};

}  // namespace catoptric::raster
