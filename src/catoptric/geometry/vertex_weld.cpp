// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/vertex_weld.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace catoptric::geometry {
namespace {

/// Points of D coordinates, scaled so that the tolerance is 1, in a hashed grid of cells 16 wide. A point can
/// only match points of its own cell and of those whose border is less than 1 away: one or two look-ups on
/// average, not 3^D.
template <std::size_t D>
class ToleranceGrid {
 public:
  using Point = std::array<double, D>;

  explicit ToleranceGrid(std::size_t capacity) {
    std::size_t slots = 16;
    while (slots < 2 * capacity) slots *= 2;
    heads_.assign(slots, kNone);
    hashes_.assign(slots, 0);
    points_.reserve(capacity);
    next_.reserve(capacity);
  }

  /// Index (in order of insertion) of the first point that matches, or of the new one.
  std::uint32_t findOrInsert(const Point& point, std::uint32_t id) {
    Cell cell;
    std::array<int, D> side;
    for (std::size_t i = 0; i < D; ++i) {
      const double c = std::floor(point[i] / kCellWidth);
      const double inside = point[i] - c * kCellWidth;
      cell[i] = static_cast<std::int64_t>(c);
      side[i] = inside < 1.0 ? -1 : (inside > kCellWidth - 1.0 ? 1 : 0);
    }
    if (const auto found = search(cell, side, 0, point); found != kNone) return found;
    insert(cell, point, id);
    return id;
  }

 private:
  using Cell = std::array<std::int64_t, D>;
  static constexpr double kCellWidth = 16.0;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  static std::uint64_t hashCell(const Cell& cell) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::int64_t c : cell) {
      h ^= static_cast<std::uint64_t>(c);
      h *= 0xff51afd7ed558ccdu;
      h ^= h >> 32;
    }
    return h | 1u;  // 0 marks a free slot
  }

  std::size_t slotOf(std::uint64_t hash) const {
    std::size_t slot = hash >> 1 & (heads_.size() - 1);
    while (hashes_[slot] != 0 && hashes_[slot] != hash) slot = (slot + 1) & (heads_.size() - 1);
    return slot;
  }

  std::uint32_t search(Cell cell, const std::array<int, D>& side, std::size_t axis,
                       const Point& point) const {
    for (; axis < D; ++axis) {
      if (side[axis] == 0) continue;
      if (const auto found = search(cell, side, axis + 1, point); found != kNone) return found;
      cell[axis] += side[axis];
    }
    for (std::uint32_t i = heads_[slotOf(hashCell(cell))]; i != kNone; i = next_[i])
      if (matches(points_[i], point)) return ids_[i];
    return kNone;
  }

  static bool matches(const Point& a, const Point& b) {
    for (std::size_t i = 0; i < D; ++i)
      if (std::abs(a[i] - b[i]) > 1.0) return false;
    return true;
  }

  void insert(const Cell& cell, const Point& point, std::uint32_t id) {
    const std::uint64_t hash = hashCell(cell);
    const std::size_t slot = slotOf(hash);
    hashes_[slot] = hash;
    next_.push_back(heads_[slot]);
    heads_[slot] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    ids_.push_back(id);
  }

  std::vector<std::uint32_t> heads_;
  std::vector<std::uint64_t> hashes_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> next_, ids_;
};

}  // namespace

std::vector<std::uint32_t> weldVertices(std::span<const vec3> positions, std::span<const vec3> normals,
                                        const WeldOptions& options) {
  assert(normals.empty() || normals.size() == positions.size());
  assert(options.positionTolerance > 0);
  const double scale = 1.0 / options.positionTolerance;
  const double normalScale = 1.0 / options.normalTolerance;

  std::vector<std::uint32_t> welded(positions.size());
  const auto count = static_cast<std::uint32_t>(positions.size());
  if (normals.empty()) {
    ToleranceGrid<3> grid(positions.size());
    for (std::uint32_t v = 0; v < count; ++v) {
      const dvec3 p = dvec3(positions[v]) * scale;
      welded[v] = grid.findOrInsert({p.x, p.y, p.z}, v);
    }
    return welded;
  }
  ToleranceGrid<6> grid(positions.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    const dvec3 p = dvec3(positions[v]) * scale, n = dvec3(normals[v]) * normalScale;
    welded[v] = grid.findOrInsert({p.x, p.y, p.z, n.x, n.y, n.z}, v);
  }
  return welded;
}

std::vector<std::uint32_t> weldPlanes(std::span<const core::Plane> planes, double normalTolerance,
                                      double offsetTolerance) {
  ToleranceGrid<4> grid(planes.size());
  std::vector<std::uint32_t> welded(planes.size());
  for (std::uint32_t i = 0; i < planes.size(); ++i) {
    const dvec3 n = planes[i].normal / normalTolerance;
    welded[i] = grid.findOrInsert({n.x, n.y, n.z, planes[i].offset / offsetTolerance}, i);
  }
  return welded;
}

}  // namespace catoptric::geometry
