// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/sampled_surface.h"

#include <cassert>
#include <cmath>

namespace catoptric::geometry {

Mesh makeHeightField(int cellsX, int cellsY, const std::function<dvec2(dvec2)>& place,
                     const std::function<HeightSample(dvec2)>& height) {
  assert(cellsX >= 1 && cellsY >= 1);
  Mesh mesh;
  for (int row = 0; row <= cellsY; ++row)
    for (int column = 0; column <= cellsX; ++column) {
      const dvec2 p = place({2.0 * column / cellsX - 1, 2.0 * row / cellsY - 1});
      const HeightSample at = height(p);
      mesh.positions.push_back(vec3(dvec3(p, at.z)));
      mesh.normals.push_back(vec3(glm::normalize(dvec3(-at.dzdx, -at.dzdy, 1))));
    }
  const auto index = [&](int column, int row) { return std::uint32_t(row * (cellsX + 1) + column); };
  for (int row = 0; row < cellsY; ++row)
    for (int column = 0; column < cellsX; ++column) {
      const std::uint32_t a = index(column, row), b = index(column + 1, row), c = index(column + 1, row + 1),
                          d = index(column, row + 1);
      // Diagonals lead away from the middle: where a round outline cuts the grid's corners off, the other
      // diagonal would leave slivers of three points of the outline.
      if ((2 * column < cellsX) == (2 * row < cellsY))
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
      else
        mesh.indices.insert(mesh.indices.end(), {a, b, d, b, c, d});
    }
  return mesh;
}

Mesh makeRevolvedSide(double height, int segmentsAround, int rows,
                      const std::function<RadiusSample(double y)>& radius) {
  assert(segmentsAround >= 3 && rows >= 1);
  constexpr double kTwoPi = 6.283185307179586;
  Mesh mesh;
  for (int row = 0; row <= rows; ++row) {
    const double y = height * row / rows;
    const RadiusSample at = radius(y);
    for (int column = 0; column < segmentsAround; ++column) {
      const double angle = kTwoPi * column / segmentsAround;
      const dvec3 out(std::sin(angle), 0, std::cos(angle));
      mesh.positions.push_back(vec3(at.radius * out + dvec3(0, y, 0)));
      mesh.normals.push_back(vec3(glm::normalize(out - dvec3(0, at.slope, 0))));
    }
  }
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < segmentsAround; ++column) {
      const auto index = [&](int c, int r) { return std::uint32_t(r * segmentsAround + c % segmentsAround); };
      const std::uint32_t a = index(column, row), b = index(column + 1, row), c = index(column + 1, row + 1),
                          d = index(column, row + 1);
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

}  // namespace catoptric::geometry
