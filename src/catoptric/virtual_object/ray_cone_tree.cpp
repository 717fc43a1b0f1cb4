// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/ray_cone_tree.h"

#include <algorithm>
#include <cmath>

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kLeafCells = 4;
constexpr double kSlack = 1e-9;

}  // namespace

bool RayConeTree::mayHold(const Node& node, const dvec3& point) {
  const dvec3 away = point - node.centre;
  const double distance = glm::length(away);
  if (distance <= node.radius) return true;
  const double reach = node.halfAngleRadians + std::asin(node.radius / distance) + kSlack;
  return reach >= 3.1415926 || glm::dot(away, node.axis) >= std::cos(reach) * distance;
}

void RayConeTree::build(std::span<const Cell> cells) {
  nodes_.clear(), ids_.clear(), entries_.clear();
  if (cells.empty()) return;
  core::Box box;
  for (const Cell& cell : cells)
    for (const dvec3& start : cell.starts) box.add(start);
  const double scale = box.radius() > 0 ? 1.0 / box.radius() : 0.0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    const dvec3 start = (cell.starts[0] + cell.starts[1] + cell.starts[2]) * (scale / 3.0),
                direction = (cell.directions[0] + cell.directions[1] + cell.directions[2]) / 3.0;
    entries_.push_back({i, {start.x, start.y, start.z, direction.x, direction.y, direction.z}});
  }
  nodes_.emplace_back();
  fillNode(0, cells, 0, entries_.size());
}

void RayConeTree::fillNode(std::uint32_t index, std::span<const Cell> cells, std::size_t begin,
                           std::size_t end) {
  Node node;
  core::Box box;
  dvec3 sum(0);
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      box.add(cells[entries_[i].cell].starts[k]);
      sum += cells[entries_[i].cell].directions[k];
    }
  const double length = glm::length(sum);
  node.centre = box.centre();
  node.axis = length > 0 ? sum / length : dvec3(0, 0, 1);
  double leastCosine = 1;
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Cell& cell = cells[entries_[i].cell];
      node.radius = std::max(node.radius, glm::distance(cell.starts[k], node.centre));
      leastCosine = std::min(leastCosine, glm::dot(cell.directions[k], node.axis));
    }
  // Between the corners' directions the blends stay within their cone only while it is narrower than a
  // half-space.
  node.halfAngleRadians = leastCosine > 0 ? std::acos(std::min(leastCosine, 1.0)) : 3.2;
  if (end - begin <= kLeafCells) {
    node.first = std::uint32_t(ids_.size());
    node.count = std::uint32_t(end - begin);
    for (std::size_t i = begin; i < end; ++i) ids_.push_back(cells[entries_[i].cell].id);
    nodes_[index] = node;
    return;
  }
  std::array<double, 6> low, high;
  low.fill(1e300), high.fill(-1e300);
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 6; ++k) {
      low[k] = std::min(low[k], entries_[i].key[k]);
      high[k] = std::max(high[k], entries_[i].key[k]);
    }
  std::size_t widest = 0;
  for (std::size_t k = 1; k < 6; ++k)
    if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
  const std::size_t middle = (begin + end) / 2;
  std::nth_element(entries_.begin() + std::ptrdiff_t(begin), entries_.begin() + std::ptrdiff_t(middle),
                   entries_.begin() + std::ptrdiff_t(end),
                   [&](const Entry& a, const Entry& b) { return a.key[widest] < b.key[widest]; });
  node.first = std::uint32_t(nodes_.size());
  nodes_[index] = node;
  nodes_.emplace_back(), nodes_.emplace_back();
  fillNode(node.first, cells, begin, middle);
  fillNode(node.first + 1, cells, middle, end);
}

}  // namespace catoptric::virtual_object
