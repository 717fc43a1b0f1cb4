// SPDX-License-Identifier: Apache-2.0
// A hierarchy over unbounded cells of space: each cell is swept by a triangle whose corners travel along
// rays. Which cells may hold a point?
//
// A node keeps a ball that holds the starts of all its rays and a cone that holds all their directions. The
// point can lie in one of its cells only if the angle between the cone's axis and the direction from the
// ball's centre is at most the cone's half angle plus what the ball covers, asin(radius / distance). Built by
// halving along the widest extent of starts (relative to their size) or directions. Exact in the sense that
// it never loses a cell. Cost: n log n to build; a query visits about log n nodes where cells do not overlap.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::virtual_object {

class RayConeTree {
 public:
  struct Cell {
    std::uint32_t id;
    std::array<dvec3, 3> starts, directions;  ///< directions unit
  };

  void build(std::span<const Cell> cells);

  /// Calls visit(id) for every cell that may hold the point; it may be called for others, too.
  template <class Visit>
  void forCandidates(const dvec3& point, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!mayHold(node, point)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = 0; i < node.count; ++i) visit(ids_[node.first + i]);
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

 private:
  struct Node {
    dvec3 centre{0}, axis{0, 0, 1};
    double radius = 0, halfAngleRadians = 0;
    std::uint32_t first = 0, count = 0;  ///< children first, first + 1; or ids
  };
  struct Entry {
    std::uint32_t cell;
    std::array<double, 6> key;  ///< mean start, mean direction
  };

  [[nodiscard]] static bool mayHold(const Node& node, const dvec3& point);
  void fillNode(std::uint32_t node, std::span<const Cell> cells, std::size_t begin, std::size_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> ids_;
  std::vector<Entry> entries_;
};

}  // namespace catoptric::virtual_object
