// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/part_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "catoptric/raster/edge_table.h"

namespace catoptric::raster {
namespace {

/// Bits of three numbers of 21 bits, one of each in turn.
std::uint64_t computeMortonCode(const glm::uvec3& cell) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 21; ++bit)
    for (int axis = 0; axis < 3; ++axis) code |= std::uint64_t(cell[axis] >> bit & 1u) << (3 * bit + axis);
  return code;
}

/// Of an edge between two vertices.
std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

class PartCutter {
 public:
  PartCutter(const scene::WorldGeometry& geometry, const CutOrder& order, std::atomic<std::size_t>& made)
      : geometry_(geometry),
        order_(order),
        mirror_(order.part.isSeenFromBehind ? nullptr : order.mirror),
        made_(made),
        numberOf_(order.part.vertexCount, core::kNoId) {}

  PartPieces cut() {
    const std::size_t triangles = order_.corners.size() / 3;
    pieces_.reserve(2 * std::min<std::size_t>(order_.part.vertexCount, 3 * triangles));
    if (order_.inPlaneK > order_.k) findOutlines();
    for (std::size_t t = 0; t < triangles; ++t) {
      const std::uint32_t* corner = &order_.corners[3 * t];
      if (mirror_ && turnsAway(corner)) continue;
      cutTriangle({copyVertex(corner[0]), copyVertex(corner[1]), copyVertex(corner[2])},
                  order_.firstTriangle + std::uint32_t(t));
      if (made_.load(std::memory_order_relaxed) > order_.budget) break;
    }
    orderTriangles();
    numberVerticesByUse();
    return std::move(pieces_);
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;
  /// In outlines_, besides the one side on which a triangle was found: twice its number, plus one where it
  /// goes along the edge upwards.
  static constexpr std::uint32_t kSeveral = 0xfffffffeu - 1, kInPlane = 0xfffffffeu;

  /// Does the reflector's bounding sphere lie behind the triangle's plane?
  [[nodiscard]] bool turnsAway(const std::uint32_t* corner) const {
    const dvec3 a(geometry_.positions[corner[0]]), b(geometry_.positions[corner[1]]),
        c(geometry_.positions[corner[2]]);
    const dvec3 normal = glm::cross(b - a, c - a);
    constexpr double kRounding = 1e-5;
    return glm::dot(normal, mirror_->centre - a) < -(1.0 + kRounding) * mirror_->radius * glm::length(normal);
  }

  /// Long edges of the uncut triangles, without those on whose other side the plane goes on.
  void findOutlines() {
    const std::size_t triangles = order_.corners.size() / 3;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      const std::uint32_t* corner = &order_.corners[3 * std::size_t(t)];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = copyVertex(corner[k]), b = copyVertex(corner[(k + 1) % 3]);
        if (!isLonger(a, b, order_.k)) continue;
        std::uint32_t& outline = outlines_[keyOf(a, b)];
        const std::uint32_t side = 2 * t + (a < b ? 1 : 0);
        if (outline == core::kNoId)
          outline = side;
        else
          outline = outline < kSeveral && (outline ^ side) % 2 == 1 && areInOnePlane(outline / 2, t)
                        ? kInPlane
                        : kSeveral;
      }
    }
  }

  /// Are they, with their fronts to the same side?
  [[nodiscard]] bool areInOnePlane(std::uint32_t s, std::uint32_t t) const {
    constexpr float kSine = 1e-3f;
    vec3 normals[2];
    for (int i = 0; i < 2; ++i) {
      const std::uint32_t* corner = &order_.corners[3 * std::size_t(i == 0 ? s : t)];
      const vec3& a = geometry_.positions[corner[0]];
      normals[i] = glm::cross(geometry_.positions[corner[1]] - a, geometry_.positions[corner[2]] - a);
    }
    const vec3 sine = glm::cross(normals[0], normals[1]);
    const float cosine = glm::dot(normals[0], normals[1]);
    return cosine > 0 && glm::dot(sine, sine) < kSine * kSine * cosine * cosine;
  }

  [[nodiscard]] bool isOutline(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t outline = outlines_.find(keyOf(a, b));
    return outline != core::kNoId && outline != kInPlane;
  }

  /// Its number among the pieces.
  std::uint32_t copyVertex(std::uint32_t v) {
    std::uint32_t& number = numberOf_[v - order_.part.firstVertex];
    if (number != core::kNoId) return number;
    number = std::uint32_t(pieces_.positions.size());
    pieces_.positions.push_back(geometry_.positions[v]);
    pieces_.normals.push_back(geometry_.normals[v]);
    pieces_.tangents.push_back(geometry_.tangents[v]);
    pieces_.uv0.push_back(geometry_.uv0[v]);
    pieces_.uv1.push_back(geometry_.uv1[v]);
    pieces_.colors.push_back(geometry_.colors[v]);
    measureLastVertex();
    return number;
  }

  /// Along a space-filling curve (Morton 1966), so that runs of triangles, and of the vertices numbered after
  /// them, stay together: what cannot be reflected is left out run by run.
  void orderTriangles() {
    constexpr double kSteps = 1 << 20;
    core::Box box;
    for (const vec3& p : pieces_.positions) box.add(dvec3(p));
    const dvec3 scale = kSteps / glm::max(box.upper - box.lower, dvec3(1e-30));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(pieces_.sources.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) {
      dvec3 sum(0);
      for (std::uint32_t k = 0; k < 3; ++k) sum += dvec3(pieces_.positions[pieces_.indices[3 * t + k]]);
      order[t] = {computeMortonCode(glm::uvec3((sum / 3.0 - box.lower) * scale)), t};
    }
    std::sort(order.begin(), order.end());
    const std::vector<std::uint32_t> indices = std::move(pieces_.indices),
                                     sources = std::move(pieces_.sources);
    pieces_.indices.clear(), pieces_.sources.clear();
    for (const auto& [code, t] : order) {
      pieces_.indices.insert(pieces_.indices.end(), {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]});
      pieces_.sources.push_back(sources[t]);
    }
  }

  /// Drops the unused ones, each of which would cost a search for its reflection point, and puts the others
  /// in the order in which triangles use them: neighbours in the array are neighbours in space.
  void numberVerticesByUse() {
    std::vector<std::uint32_t> numberOf(pieces_.positions.size(), core::kNoId), used;
    for (std::uint32_t& v : pieces_.indices) {
      if (numberOf[v] == core::kNoId) {
        numberOf[v] = std::uint32_t(used.size());
        used.push_back(v);
      }
      v = numberOf[v];
    }
    const auto gather = [&used](auto& values) {
      auto old = std::move(values);
      values.clear();
      values.reserve(used.size());
      for (const std::uint32_t v : used) values.push_back(old[v]);
    };
    gather(pieces_.positions), gather(pieces_.normals), gather(pieces_.tangents);
    gather(pieces_.uv0), gather(pieces_.uv1), gather(pieces_.colors);
  }

  void measureLastVertex() {
    distances_.push_back(order_.distance(pieces_.positions.back()));
    isBehind_.push_back(order_.distance.isBehind(pieces_.positions.back()));
  }

  [[nodiscard]] bool isLonger(std::uint32_t a, std::uint32_t b, float k) const {
    const vec3 edge = pieces_.positions[b] - pieces_.positions[a];
    const float length = std::sqrt(glm::dot(edge, edge));
    const float d = std::max(0.5f * (distances_[a] + distances_[b] - length), 0.0f);
    return length > k * (d + order_.floor);
  }

  [[nodiscard]] bool isTooLong(std::uint32_t a, std::uint32_t b) const {
    if (!isLonger(a, b, order_.k)) return false;
    return isLonger(a, b, order_.inPlaneK) || isOutline(a, b);
  }

  std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
    std::uint32_t& middle = middles_[keyOf(a, b)];
    if (middle != core::kNoId) return middle;
    middle = std::uint32_t(pieces_.positions.size());
    const auto addMean = [a, b](auto& values) { values.push_back((values[a] + values[b]) * 0.5f); };
    addMean(pieces_.positions), addMean(pieces_.normals), addMean(pieces_.tangents);
    addMean(pieces_.uv0), addMean(pieces_.uv1), addMean(pieces_.colors);
    pieces_.tangents.back().w = pieces_.tangents[a].w;  // handedness is no length
    measureLastVertex();
    if (isOutline(a, b)) {
      outlines_[keyOf(a, middle)] = kSeveral;
      outlines_[keyOf(middle, b)] = kSeveral;
    }
    return middle;
  }

  void emit(const Corners& c, std::uint32_t source) {
    pieces_.indices.insert(pieces_.indices.end(), c.begin(), c.end());
    pieces_.sources.push_back(source);
    made_.fetch_add(1, std::memory_order_relaxed);
  }

  void cutTriangle(const Corners& whole, std::uint32_t source) {
    stack_.assign(1, whole);
    while (!stack_.empty() && made_.load(std::memory_order_relaxed) <= order_.budget) {
      Corners c = stack_.back();
      stack_.pop_back();
      if (isBehind_[c[0]] && isBehind_[c[1]] && isBehind_[c[2]]) continue;
      int mask = 0;
      for (int k = 0; k < 3; ++k) mask |= isTooLong(c[k], c[(k + 1) % 3]) << k;
      if (mask == 0) {
        emit(c, source);
        continue;
      }
      // Turn the triangle so that the marked edges are: 0; 0 and 1; or all.
      while (!(mask == 1 || mask == 3 || mask == 7)) {
        c = {c[1], c[2], c[0]};
        mask = mask >> 1 | (mask & 1) << 2;
      }
      const std::uint32_t m0 = middleOf(c[0], c[1]);
      if (mask == 1) {
        push({m0, c[2], c[0]}), push({m0, c[1], c[2]});
        continue;
      }
      const std::uint32_t m1 = middleOf(c[1], c[2]);
      if (mask == 3) {
        push({m0, c[1], m1}), push({c[0], m0, m1}), push({c[0], m1, c[2]});
        continue;
      }
      const std::uint32_t m2 = middleOf(c[2], c[0]);
      push({c[0], m0, m2}), push({m0, c[1], m1}), push({m2, m1, c[2]}), push({m0, m1, m2});
    }
  }

  void push(const Corners& c) { stack_.push_back(c); }

  const scene::WorldGeometry& geometry_;
  const CutOrder& order_;
  const scene::Reflector* mirror_;
  std::atomic<std::size_t>& made_;
  std::vector<std::uint32_t> numberOf_;  ///< by vertex of the part
  EdgeTable middles_;
  EdgeTable outlines_;  ///< by edge
  std::vector<Corners> stack_;
  std::vector<float> distances_;        ///< to the mirror, by vertex of the pieces
  std::vector<std::uint8_t> isBehind_;  ///< likewise
  PartPieces pieces_;
};

}  // namespace

PartPieces cutPart(const scene::WorldGeometry& geometry, const CutOrder& order,
                   std::atomic<std::size_t>& made) {
  return PartCutter(geometry, order, made).cut();
}

}  // namespace catoptric::raster
