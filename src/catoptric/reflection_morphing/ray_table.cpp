// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/ray_table.h"

#include <algorithm>

namespace catoptric::reflection_morphing {
namespace {

std::uint8_t describeCell(const RayMap& map, int x, int y) {
  const bool isAtEnd = x + 1 == map.size || y + 1 == map.size;
  unsigned cell = !isAtEnd && map.isCell(x, y) ? RayTable::kFilled : 0u;
  for (int corner = 0; corner < 4; ++corner) {
    const int cornerX = x + corner % 2, cornerY = y + corner / 2;
    if (cornerX < map.size && cornerY < map.size && map.states[map.at(cornerX, cornerY)] == TexelState::Ray)
      cell |= RayTable::kRay << corner;
  }
  return std::uint8_t(cell);
}

}  // namespace

std::size_t RayTable::countRays() const {
  return std::size_t(
      std::count_if(cells.begin(), cells.end(), [](std::uint8_t cell) { return (cell & kRay) != 0; }));
}

RayTable makeRayTable(const RayMap& map) {
  RayTable table{map.trace, map.location, map.chart, map.lower, map.step, map.size, {}, {}, {}};
  const auto toFrame = [&](const vec3& v) {
    return vec3(glm::dot(v, map.chart.right), glm::dot(v, map.chart.up), glm::dot(v, map.chart.axis));
  };
  table.leaving.resize(map.texels.size());
  if (map.trace.size() > 1) table.origins.resize(map.texels.size());
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    const RayTexel& texel = map.texels[i];
    table.leaving[i] = vec4(toFrame(texel.direction), texel.distance);
    if (!table.origins.empty()) table.origins[i] = vec4(toFrame(texel.origin - map.location), texel.between);
  }
  table.cells.assign(map.states.size(), 0);
  for (int y = 0; y < map.size; ++y)
    for (int x = 0; x < map.size; ++x) table.cells[map.at(x, y)] = describeCell(map, x, y);
  return table;
}

}  // namespace catoptric::reflection_morphing
