// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/marks.h"

#include <span>

#include "catoptric/gl/framebuffer.h"

namespace catoptric::raster {

void Marks::addBox(const dvec3& lower, const dvec3& upper, const vec3& color) {
  const auto corner = [&](unsigned k) {
    return dvec3((k & 1u) != 0 ? upper.x : lower.x, (k & 2u) != 0 ? upper.y : lower.y,
                 (k & 4u) != 0 ? upper.z : lower.z);
  };
  for (unsigned k = 0; k < 8; ++k)
    for (const unsigned bit : {1u, 2u, 4u})
      if ((k & bit) == 0) addLine(corner(k), corner(k | bit), color);
}

MarksPass::MarksPass()
    : program_("raster/marks.vert", "raster/marks.frag"),
      positions_(gl::BufferKind::Vertex),
      colors_(gl::BufferKind::Vertex) {}

void MarksPass::draw(const Marks& marks, const dmat4& clipFromWorld, const Level& target) {
  target.plainTarget().bind();
  gl::setDrawState({});
  program_.use();
  program_.set("u_clipFromWorld", mat4(clipFromWorld));
  const auto drawSome = [&](const std::vector<vec3>& positions, const std::vector<vec3>& colors,
                            const auto& draw) {
    if (positions.empty()) return;
    positions_.upload(std::span<const vec3>(positions), true);
    colors_.upload(std::span<const vec3>(colors), true);
    array_.setAttribute(0, positions_, 3);
    array_.setAttribute(1, colors_, 3);
    array_.bind();
    draw(std::uint32_t(positions.size()));
  };
  drawSome(marks.pointPositions, marks.pointColors, gl::drawPoints);
  drawSome(marks.linePositions, marks.lineColors, gl::drawLines);
}

}  // namespace catoptric::raster
