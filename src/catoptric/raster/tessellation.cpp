// SPDX-License-Identifier: Apache-2.0
// Cuts what a reflector may reflect.
//
//   1. A few samples of the reflector's surface, farthest first; d of a point is the distance to the nearest
//   sample
//      less the radius that a sample stands for. Focal length c from the median curvature of the normals.
//   2. k from the error bound in pixels. An edge of angular length phi (seen from the mirror) that is drawn
//      straight misses its image by the sag of that image, about phi^2 / 8 times its radius of curvature on
//      the screen, and by as much again along itself, because depth in the virtual object is path length and
//      not the depth that would make perspective interpolation exact. Both grow with the diameter D that a
//      ball as curved as the mirror has on the screen, 4 c times the pixels of a unit of length:
//          error_px = kSagFactor D_px phi^2,   phi = L / (d + c) <= k = sqrt(maxErrorPx / (kSagFactor D_px)).
//      What lies behind a mirror that turns all the way round appears in a thin ring at its rim, where long
//      edges bend by more than the ring is wide, however small the mirror is: D is kLeastTurnedPx at least
//      there. kSagFactor is fitted to the worst 2 % of pixels of the test scenes (tests/unit/virtual_object).
//   3. Every triangle by itself: mark edges with L > k (d + c), d = (d_a + d_b - L) / 2, the least that the
//      edge's points can be away from the reflector; split in two, three or four; repeat on the pieces. New
//      vertices are shared within a part through a table of edges.
//      Pieces with all corners behind every tangent plane of the mirror are left out: nothing reflects them.
//   4. More triangles than the budget: start again with k a third larger.
//
// Departures: the papers tessellate uniformly and by hand. Failures: a triangle that crosses the mirror is
// cut to the floor k c only. Cost: about 0.25 us per triangle made, parts in parallel.
#include "catoptric/raster/tessellation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"
#include "catoptric/raster/reflector_distance.h"

namespace catoptric::raster {
namespace {

constexpr double kSagFactor = 0.06;
constexpr double kLeastTurnedPx = 700;
constexpr double kBudgetStep = 1.35;

/// Open addressing from an edge to the vertex at its middle.
class EdgeTable {
 public:
  EdgeTable() { resize(1024); }

  /// The slot of edge (a, b); its value is kNoId if the edge is new.
  std::uint32_t& operator[](std::uint64_t key) {
    if (2 * count_ >= keys_.size()) grow();
    std::size_t slot = findSlot(key);
    if (keys_[slot] == kFree) keys_[slot] = key, ++count_;
    return values_[slot];
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t(0);

  [[nodiscard]] std::size_t findSlot(std::uint64_t key) const {
    std::size_t slot = (key * 0x9e3779b97f4a7c15u) >> shift_;
    while (keys_[slot] != kFree && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
    return slot;
  }
  void resize(std::size_t slots) {
    keys_.assign(slots, kFree);
    values_.assign(slots, core::kNoId);
    shift_ = 64;
    for (std::size_t s = slots; s > 1; s /= 2) --shift_;
  }
  void grow() {
    std::vector<std::uint64_t> keys = std::move(keys_);
    std::vector<std::uint32_t> values = std::move(values_);
    resize(2 * keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i] == kFree) continue;
      const std::size_t slot = findSlot(keys[i]);
      keys_[slot] = keys[i], values_[slot] = values[i];
    }
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
  std::size_t count_ = 0;
  int shift_ = 54;
};

/// Bits of three numbers of 21 bits, one of each in turn.
std::uint64_t computeMortonCode(const glm::uvec3& cell) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 21; ++bit)
    for (int axis = 0; axis < 3; ++axis) code |= std::uint64_t(cell[axis] >> bit & 1u) << (3 * bit + axis);
  return code;
}

/// The pieces of one part; indices are local.
struct PartPieces {
  std::vector<vec3> positions, normals;
  std::vector<vec4> tangents;
  std::vector<vec2> uv0, uv1;
  std::vector<vec4> colors;
  std::vector<float> distances;
  std::vector<std::uint8_t> isBehind;
  std::vector<std::uint32_t> indices, sources;

  void reserve(std::size_t vertices) {
    positions.reserve(vertices), normals.reserve(vertices), tangents.reserve(vertices);
    uv0.reserve(vertices), uv1.reserve(vertices), colors.reserve(vertices), distances.reserve(vertices);
  }
};

class PartCutter {
 public:
  /// `mirror`: triangles that turn their back to all of it are left out; may be null.
  PartCutter(const scene::WorldGeometry& geometry, const scene::Part& part, const ReflectorDistance& distance,
             const scene::Reflector* mirror, float k, std::size_t budget, std::atomic<std::size_t>& made)
      : geometry_(geometry),
        part_(part),
        distance_(distance),
        mirror_(part.isSeenFromBehind ? nullptr : mirror),
        k_(k),
        budget_(budget),
        made_(made) {}

  PartPieces cut() {
    pieces_.reserve(part_.vertexCount * 2);
    for (std::uint32_t v = part_.firstVertex; v < part_.firstVertex + part_.vertexCount; ++v) copyVertex(v);
    for (std::uint32_t i = 0; i + 2 < part_.indexCount; i += 3) {
      const std::uint32_t* corner = &geometry_.indices[part_.firstIndex + i];
      if (mirror_ && turnsAway(corner)) continue;
      cutTriangle(
          {corner[0] - part_.firstVertex, corner[1] - part_.firstVertex, corner[2] - part_.firstVertex},
          (part_.firstIndex + i) / 3);
      if (made_.load(std::memory_order_relaxed) > budget_) break;
    }
    orderTriangles();
    numberVerticesByUse();
    return std::move(pieces_);
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  /// Does the reflector's bounding sphere lie behind the triangle's plane?
  [[nodiscard]] bool turnsAway(const std::uint32_t* corner) const {
    const dvec3 a(geometry_.positions[corner[0]]), b(geometry_.positions[corner[1]]),
        c(geometry_.positions[corner[2]]);
    const dvec3 normal = glm::cross(b - a, c - a);
    constexpr double kRounding = 1e-5;
    return glm::dot(normal, mirror_->centre - a) < -(1.0 + kRounding) * mirror_->radius * glm::length(normal);
  }

  void copyVertex(std::uint32_t v) {
    pieces_.positions.push_back(geometry_.positions[v]);
    pieces_.normals.push_back(geometry_.normals[v]);
    pieces_.tangents.push_back(geometry_.tangents[v]);
    pieces_.uv0.push_back(geometry_.uv0[v]);
    pieces_.uv1.push_back(geometry_.uv1[v]);
    pieces_.colors.push_back(geometry_.colors[v]);
    measureLastVertex();
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
    pieces_.distances.push_back(distance_(pieces_.positions.back()));
    pieces_.isBehind.push_back(distance_.isBehind(pieces_.positions.back()));
  }

  [[nodiscard]] bool isTooLong(std::uint32_t a, std::uint32_t b) const {
    const vec3 edge = pieces_.positions[b] - pieces_.positions[a];
    const float length = std::sqrt(glm::dot(edge, edge));
    const float d = std::max(0.5f * (pieces_.distances[a] + pieces_.distances[b] - length), 0.0f);
    return length > k_ * (d + distance_.focalLength());
  }

  std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
    std::uint32_t& middle = middles_[std::uint64_t(std::min(a, b)) << 32 | std::max(a, b)];
    if (middle != core::kNoId) return middle;
    middle = std::uint32_t(pieces_.positions.size());
    const auto addMean = [a, b](auto& values) { values.push_back((values[a] + values[b]) * 0.5f); };
    addMean(pieces_.positions), addMean(pieces_.normals), addMean(pieces_.tangents);
    addMean(pieces_.uv0), addMean(pieces_.uv1), addMean(pieces_.colors);
    pieces_.tangents.back().w = pieces_.tangents[a].w;  // handedness is no length
    measureLastVertex();
    return middle;
  }

  void emit(const Corners& c, std::uint32_t source) {
    pieces_.indices.insert(pieces_.indices.end(), c.begin(), c.end());
    pieces_.sources.push_back(source);
    made_.fetch_add(1, std::memory_order_relaxed);
  }

  void cutTriangle(const Corners& whole, std::uint32_t source) {
    stack_.assign(1, whole);
    while (!stack_.empty() && made_.load(std::memory_order_relaxed) <= budget_) {
      Corners c = stack_.back();
      stack_.pop_back();
      if (pieces_.isBehind[c[0]] && pieces_.isBehind[c[1]] && pieces_.isBehind[c[2]]) continue;
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
  const scene::Part& part_;
  const ReflectorDistance& distance_;
  const scene::Reflector* mirror_;
  float k_;
  std::size_t budget_;
  std::atomic<std::size_t>& made_;
  EdgeTable middles_;
  std::vector<Corners> stack_;
  PartPieces pieces_;
};

template <class T>
void appendTo(std::vector<T>& target, const std::vector<T>& source) {
  target.insert(target.end(), source.begin(), source.end());
}

void appendPieces(TessellatedObjects& objects, std::uint32_t part, const PartPieces& pieces) {
  if (pieces.indices.empty()) return;
  TessellatedPart run{part, std::uint32_t(objects.indices.size()), std::uint32_t(pieces.indices.size()),
                      std::uint32_t(objects.positions.size()), std::uint32_t(pieces.positions.size())};
  for (const std::uint32_t i : pieces.indices) objects.indices.push_back(run.firstVertex + i);
  appendTo(objects.positions, pieces.positions), appendTo(objects.normals, pieces.normals);
  appendTo(objects.tangents, pieces.tangents), appendTo(objects.colors, pieces.colors);
  appendTo(objects.uv0, pieces.uv0), appendTo(objects.uv1, pieces.uv1);
  appendTo(objects.sourceTriangles, pieces.sources);
  objects.parts.push_back(run);
}

}  // namespace

double findTessellationSize(const scene::Reflector& reflector, const dvec3& eye,
                            const scene::CameraFrame& camera) {
  constexpr double kSmallest = 175, kLargest = 2800;
  const double distance = glm::length(eye - reflector.centre);
  const double pixelsPerRadian = camera.heightPx / (2.0 * camera.tanHalfFovY);
  const double diameter = 2.0 * reflector.radius * pixelsPerRadian;  // at distance 1
  double size = kSmallest;
  while (size < kLargest && size * distance < diameter) size *= 2.0;
  return size;
}

TessellatedObjects tessellateForReflector(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                                          const TessellationOptions& options) {
  const std::uint32_t own = geometry.reflectors[reflector].part;
  const scene::Reflector& self = geometry.reflectors[reflector];
  const ReflectorDistance distance(geometry, geometry.parts[own],
                                   options.keepsBehind || self.doubleSided || self.isRefractor());
  const double pixelsPerUnit =
      options.reflectorDiameterPx / (2.0 * std::max(geometry.reflectors[reflector].radius, 1e-30));
  const double leastPx = distance.turnsRound() ? kLeastTurnedPx : 1.0;
  const double diameterPx = std::max(4.0 * double(distance.focalLength()) * pixelsPerUnit, leastPx);
  double k = std::sqrt(std::max(options.maxErrorPx, 1e-3) / (kSagFactor * diameterPx));
  k = options.maxErrorPx < kUncutPx ? std::min(k, 0.5) : 1e30;
  const double asked = k;

  const scene::Reflector* mirror = options.isSeenDirectly ? &geometry.reflectors[reflector] : nullptr;
  const auto isCut = [&](std::size_t p) {
    return p != own && (options.parts.empty() || options.parts[p] != 0);
  };
  std::size_t uncut = 0;
  for (std::uint32_t p = 0; p < geometry.parts.size(); ++p)
    if (isCut(p)) uncut += geometry.parts[p].indexCount / 3;
  const std::size_t budget = std::max(options.maxTriangles, uncut);

  std::vector<PartPieces> pieces(geometry.parts.size());
  for (;; k *= kBudgetStep) {
    std::atomic<std::size_t> made{0};
    core::parallelFor(geometry.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        if (isCut(p))
          pieces[p] = PartCutter(geometry, geometry.parts[p], distance, mirror, float(k), budget, made).cut();
    });
    if (made.load() <= budget) break;
  }
  if (k > asked)
    core::logWarningOnce(
        fmt::format("reflector '{}': its reflections would need more than {} triangles; edges are {:.1f} "
                    "times as long as asked "
                    "for, errors may be {:.1f} times as large",
                    geometry.reflectors[reflector].name, budget, k / asked, k * k / (asked * asked)));

  TessellatedObjects objects;
  objects.edgeFactor = k;
  for (std::uint32_t p = 0; p < pieces.size(); ++p) appendPieces(objects, p, pieces[p]);
  return objects;
}

}  // namespace catoptric::raster
