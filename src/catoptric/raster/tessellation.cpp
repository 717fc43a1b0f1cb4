// SPDX-License-Identifier: Apache-2.0
// Cuts what a reflector may reflect.
//
//   1. A few samples of the reflector's surface, farthest first; d of a point is the distance to the nearest
//      sample less the radius that a sample stands for. Focal length c from the median curvature of the
//      normals.
//   2. k from the error bound in pixels. An edge of angular length phi (seen from the mirror) that is drawn
//      straight misses its image by the sag of that image, about phi^2 / 8 times its radius of curvature on
//      the screen, and by as much again along itself, because depth in the virtual object is path length and
//      not the depth that would make perspective interpolation exact. Both grow with the diameter D that a
//      ball as curved as the mirror has on the screen, 4 c times the pixels of a unit of length:
//          error_px = kSagFactor D_px phi^2,   phi = L / (d + c) <= k = sqrt(maxErrorPx / (kSagFactor D_px)).
//      What lies behind a mirror that turns all the way round appears in a thin ring at its rim, where long
//      edges bend by more than the ring is wide, however small the mirror is: D is kLeastTurnedPx at least
//      there. kSagFactor is fitted to the worst 2 % of pixels of the test scenes (tests/unit/virtual_object).
//      Close to the mirror, d below c, what it shows bends as the mirror itself does: an edge of length L by
//      L^2 / (16 c), a quarter of what the formula says. Where each pixel's own ray meets the triangle, and
//      depth and interpolation add nothing, edges are therefore split at k (d + kByRays c), if the
//      mirror is as large as kByRays c.
//      There, in a convex mirror that does not turn round, edges that may be seen as outlines are held to
//      kOutlineByRays k, and those on both sides of which one plane goes on to kInPlaneByRays k: which of the
//      two triangles a pixel is given does not matter then, their depths alone do. (In one that turns round
//      large triangles lie across the rim, and what they hide or leave free there does matter.)
//   3. Before a part is cut: one that is nowhere nearer than d is seen, in a mirror of focal length c, c /
//      (d + c) times as large as on the mirror's surface. The coarsest level of detail is taken whose error
//      is then at most kLevelShare of the bound. Where the part is a mirror, a turn of its normals by an
//      angle counts as that angle times its radius; elsewhere it may be kLargestTurn, which shading does not
//      show.
//   4. Every triangle by itself: mark edges with L > k (d + c), d = (d_a + d_b - L) / 2, the least that the
//      edge's points can be away from the reflector; split in two, three or four; repeat on the pieces. New
//      vertices are shared within a part through a table of edges.
//      Pieces with all corners behind every tangent plane of the mirror are left out: nothing reflects them.
//   5. More triangles than the budget: start again with k a third larger.
//
// Departures: the papers tessellate uniformly and by hand. Failures: a triangle that crosses the mirror is
// cut to the floor k c only. Cost: about 0.25 us per triangle made, parts in parallel.
#include "catoptric/raster/tessellation.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "catoptric/core/log.h"
#include "catoptric/core/parallel.h"

namespace catoptric::raster {
namespace {

constexpr double kSagFactor = 0.06;
constexpr float kByRays = 2;
constexpr double kOutlineByRays = 0.6, kInPlaneByRays = 2;
constexpr double kLeastTurnedPx = 700;
constexpr double kBudgetStep = 1.35;
constexpr double kLargestTurn = 0.03;  // radians

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

/// Step 2: k, for this diameter of the mirror on the screen.
double findEdgeFactor(const ReflectorDistance& distance, double pixelsPerUnit, double maxErrorPx) {
  if (maxErrorPx >= kUncutPx) return 1e30;
  const double leastPx = distance.turnsRound() ? kLeastTurnedPx : 1.0;
  const double diameterPx = std::max(4.0 * double(distance.focalLength()) * pixelsPerUnit, leastPx);
  return std::min(std::sqrt(std::max(maxErrorPx, 1e-3) / (kSagFactor * diameterPx)), 0.5);
}

/// Step 2: edges are split at k (d + this).
float findFloor(const ReflectorDistance& distance, const scene::Reflector& mirror, bool byRays) {
  // Not beyond the mirror's radius: triangles larger than an open mirror have corners that it cannot reflect.
  const float c = distance.focalLength();
  return byRays ? std::max(c, std::min(kByRays * c, float(mirror.radius))) : c;
}

double findPixelsPerUnit(const scene::Reflector& reflector, const TessellationOptions& options) {
  return options.reflectorDiameterPx / (2.0 * std::max(reflector.radius, 1e-30));
}

/// Step 3; null for the part's own triangles.
const DetailLevel* chooseLevel(const scene::WorldGeometry& geometry, const scene::Reflector& reflector,
                               const ReflectorDistance& distance, const TessellationOptions& options,
                               std::uint32_t p) {
  if (!options.levels || options.maxErrorPx >= kUncutPx || !reflector.isConvex) return nullptr;
  const double pixelsPerUnit = findPixelsPerUnit(reflector, options);
  const auto levels = options.levels->levels(p);
  if (levels.empty()) return nullptr;
  const scene::Part& part = geometry.parts[p];
  core::Box box;
  for (std::uint32_t v = 0; v < part.vertexCount; ++v)
    box.add(dvec3(geometry.positions[part.firstVertex + v]));
  const double c = distance.focalLength();
  const double d = std::max(double(distance(vec3(box.centre()))) - box.radius(), 0.0);
  const double bound = kLevelShare * options.maxErrorPx * (d + c) / (c * pixelsPerUnit);
  const scene::Reflector* mirror =
      part.reflector == core::kNoId ? nullptr : &geometry.reflectors[part.reflector];
  const double largestTurn = mirror ? bound / mirror->radius : kLargestTurn;
  const DetailLevel* chosen = nullptr;
  for (const DetailLevel& level : levels)
    if (options.levels->findDistance(p, level) <= bound && options.levels->findTurn(p, level) <= largestTurn)
      chosen = &level;
  return chosen;
}

/// Pieces of one triangle, from the edge length at a few places of it.
double estimatePieces(const ReflectorDistance& distance, float k, float floor, const vec3& a, const vec3& b,
                      const vec3& c, int depth) {
  constexpr float kPieceArea = 0.22f;  // of the square of the longest edge that is left; fitted
  constexpr int kDeepest = 6;
  if (distance.isBehind(a) && distance.isBehind(b) && distance.isBehind(c)) return 0;
  const float longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  const float edge = k * (distance((a + b + c) / 3.0f) + floor);
  if (longest <= edge) return 1;
  if (longest <= 3 * edge || depth == kDeepest)
    return std::max(2.0, double(0.5f * glm::length(glm::cross(b - a, c - a)) / (kPieceArea * edge * edge)));
  const vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
  double sum = 0;
  for (const auto& [x, y, z] :
       {std::tuple(a, ab, ca), std::tuple(ab, b, bc), std::tuple(ca, bc, c), std::tuple(ab, bc, ca)})
    sum += estimatePieces(distance, k, floor, x, y, z, depth + 1);
  return sum;
}

}  // namespace

void TessellatedObjects::clear() {
  positions.clear(), normals.clear(), tangents.clear();
  uv0.clear(), uv1.clear(), colors.clear();
  indices.clear(), sourceTriangles.clear(), parts.clear();
  edgeFactor = 0;
  simplifiedTriangles = 0;
}

TessellatedObjects makeUncutObjects(const scene::WorldGeometry& world) {
  TessellatedObjects objects;
  objects.indices = world.indices;
  objects.sourceTriangles.resize(world.triangleCount());
  std::iota(objects.sourceTriangles.begin(), objects.sourceTriangles.end(), 0u);
  for (std::uint32_t i = 0; i < world.parts.size(); ++i) {
    const scene::Part& part = world.parts[i];
    if (part.indexCount > 0)
      objects.parts.push_back({i, part.firstIndex, part.indexCount, part.firstVertex, part.vertexCount});
  }
  return objects;
}

double findTessellationSize(const scene::Reflector& reflector, const dvec3& eye,
                            const scene::CameraFrame& camera) {
  constexpr double kSmallest = 43.75, kLargest = 2800;
  const double distance = glm::length(eye - reflector.centre);
  const double pixelsPerRadian = camera.heightPx / (2.0 * camera.tanHalfFovY);
  const double diameter = 2.0 * reflector.radius * pixelsPerRadian;  // at distance 1
  double size = kSmallest;
  for (int step = 1; size < kLargest && size * distance < diameter; ++step)
    size = kSmallest * std::exp2(0.5 * step);
  return size;
}

ReflectorTessellation::ReflectorTessellation(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                                             const TessellationOptions& options)
    : reflector_(reflector),
      own_(geometry.reflectors[reflector].part),
      options_(options),
      wanted_(options.parts.begin(), options.parts.end()),
      byRays_(options.shadedByRays.begin(), options.shadedByRays.end()),
      distance_(geometry, geometry.parts[own_],
                options.keepsBehind || geometry.reflectors[reflector].doubleSided ||
                    geometry.reflectors[reflector].isRefractor()),
      pieces_(geometry.parts.size()),
      cutTriangles_(geometry.parts.size()) {
  options_.parts = options_.shadedByRays = {};
  askedFactor_ = findEdgeFactor(distance_, findPixelsPerUnit(geometry.reflectors[reflector], options),
                                options.maxErrorPx);
  std::size_t uncut = 0;
  for (std::uint32_t p = 0; p < geometry.parts.size(); ++p)
    if (isCut(p)) uncut += geometry.parts[p].indexCount / 3;
  budget_ = std::max(options_.maxTriangles, uncut);
  cutAll(geometry);
  gatherObjects(geometry);
}

bool ReflectorTessellation::isCut(std::size_t part) const {
  return part != own_ && (wanted_.empty() || wanted_[part] != 0);
}

bool ReflectorTessellation::isShadedByRays(std::size_t part) const {
  return !byRays_.empty() && byRays_[part] != 0;
}

const DetailLevel* ReflectorTessellation::findLevel(const scene::WorldGeometry& geometry,
                                                    std::uint32_t p) const {
  return chooseLevel(geometry, geometry.reflectors[reflector_], distance_, options_, p);
}

CutOrder ReflectorTessellation::makeOrder(const scene::WorldGeometry& geometry, std::uint32_t p) const {
  const scene::Part& part = geometry.parts[p];
  const scene::Reflector* mirror = options_.isSeenDirectly ? &geometry.reflectors[reflector_] : nullptr;
  const float floor = findFloor(distance_, geometry.reflectors[reflector_], isShadedByRays(p));
  CutOrder order{.part = part,
                 .corners = std::span(geometry.indices).subspan(part.firstIndex, part.indexCount),
                 .firstTriangle = part.firstIndex / 3,
                 .distance = distance_,
                 .mirror = mirror,
                 .k = float(k_),
                 .floor = floor,
                 .budget = budget_};
  if (options_.coarseInPlanes && isShadedByRays(p) && !distance_.turnsRound()) {
    order.k = float(kOutlineByRays * k_);
    order.inPlaneK = float(kInPlaneByRays * k_);
  }
  if (const DetailLevel* level = findLevel(geometry, p)) {
    order.corners = options_.levels->corners(*level);
    order.firstTriangle = level->firstTriangle;
  }
  return order;
}

void ReflectorTessellation::cutAll(const scene::WorldGeometry& geometry) {
  for (k_ = askedFactor_;; k_ *= kBudgetStep) {
    std::atomic<std::size_t> made{0};
    core::parallelFor(geometry.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        if (!isCut(p)) continue;
        const CutOrder order = makeOrder(geometry, std::uint32_t(p));
        cutTriangles_[p] = std::uint32_t(order.corners.size() / 3);
        pieces_[p] = cutPart(geometry, order, made);
      }
    });
    if (made.load() <= budget_) break;
  }
  if (k_ > askedFactor_)
    core::logWarningOnce(
        fmt::format("reflector '{}': its reflections would need more than {} triangles; edges are {:.1f} "
                    "times as long as asked "
                    "for, errors may be {:.1f} times as large",
                    geometry.reflectors[reflector_].name, budget_, k_ / askedFactor_,
                    k_ * k_ / (askedFactor_ * askedFactor_)));
}

void ReflectorTessellation::update(const scene::WorldGeometry& geometry,
                                   std::span<const std::uint32_t> movedParts) {
  std::size_t kept = 0;
  for (const PartPieces& pieces : pieces_) kept += pieces.sources.size();
  for (const std::uint32_t p : movedParts) kept -= std::exchange(pieces_[p], {}).sources.size();
  std::atomic<std::size_t> made{kept};
  core::parallelFor(movedParts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t p = movedParts[i];
      if (!isCut(p)) continue;
      const CutOrder order = makeOrder(geometry, p);
      cutTriangles_[p] = std::uint32_t(order.corners.size() / 3);
      pieces_[p] = cutPart(geometry, order, made);
    }
  });
  // What the budget allows depends on all of them.
  if (k_ > askedFactor_ || made.load() > budget_) cutAll(geometry);
  gatherObjects(geometry);
}

void ReflectorTessellation::gatherObjects(const scene::WorldGeometry& geometry) {
  objects_.clear();
  objects_.edgeFactor = k_;
  for (std::uint32_t p = 0; p < pieces_.size(); ++p) {
    if (isCut(p)) objects_.simplifiedTriangles += geometry.parts[p].indexCount / 3 - cutTriangles_[p];
    appendPieces(objects_, p, pieces_[p]);
  }
}

std::size_t estimateTriangles(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                              const TessellationOptions& options) {
  constexpr std::size_t kEnough = 2000;  // triangles of a part that are asked; of finer ones every so many
  const scene::Reflector& mirror = geometry.reflectors[reflector];
  const ReflectorDistance distance(geometry, geometry.parts[mirror.part],
                                   options.keepsBehind || mirror.doubleSided || mirror.isRefractor());
  const auto k = float(findEdgeFactor(distance, findPixelsPerUnit(mirror, options), options.maxErrorPx));
  std::vector<double> sums(geometry.parts.size(), 0.0);
  core::parallelFor(geometry.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (p == mirror.part || (!options.parts.empty() && options.parts[p] == 0)) continue;
      const bool byRays = !options.shadedByRays.empty() && options.shadedByRays[p] != 0;
      const float floor = findFloor(distance, mirror, byRays);
      const scene::Part& part = geometry.parts[p];
      std::span<const std::uint32_t> corners =
          std::span(geometry.indices).subspan(part.firstIndex, part.indexCount);
      if (const DetailLevel* level = chooseLevel(geometry, mirror, distance, options, std::uint32_t(p)))
        corners = options.levels->corners(*level);
      const std::size_t step = std::max<std::size_t>(1, corners.size() / 3 / kEnough);
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3 * step) {
        const vec3 &a = geometry.positions[corners[i]], &b = geometry.positions[corners[i + 1]],
                   &c = geometry.positions[corners[i + 2]];
        const dvec3 normal(glm::cross(b - a, c - a));
        if (options.isSeenDirectly && !part.isSeenFromBehind &&  // its back to all of the mirror
            glm::dot(normal, mirror.centre - dvec3(a)) < -mirror.radius * glm::length(normal))
          continue;
        sums[p] += estimatePieces(distance, k, floor, a, b, c, 0) * double(step);
      }
    }
  });
  return std::size_t(std::accumulate(sums.begin(), sums.end(), 0.0));
}

TessellatedObjects tessellateForReflector(const scene::WorldGeometry& geometry, std::uint32_t reflector,
                                          const TessellationOptions& options) {
  return ReflectorTessellation(geometry, reflector, options).takeObjects();
}

}  // namespace catoptric::raster
