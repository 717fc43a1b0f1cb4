// SPDX-License-Identifier: Apache-2.0
// Virtual vertices: where to draw a scene point Q so that an ordinary rasterizer shows its reflection in a
// curved mirror (Ofek & Rappoport 1998, sections 3 and 4; Blythe 1999; corrections in this folder's README).
//
// Everything here depends on the eye: three maps of triangle ids (near, far, hidden) and two solvers that use
// them.
//   Explosion: the method as published. Mirrors Q in the planes that the two maps name and blends the
//              results.
//   Refined:   takes the blend of the two reflection points as the start of a Newton search on the mirror
//              law, which walks across triangle edges; then Q' lies on the ray eye -> J at distance
//              |EJ| + |JQ|, so that depth order is the order of path length.
// The other solvers (analytic, layered, subdivision) are PointFinders in files of their own; what they find
// is placed here, like Refined's. World space, double inside, float at the borders.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/core/math.h"
#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/virtual_object/culling.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/lane_search.h"
#include "catoptric/virtual_object/point_finder.h"
#include "catoptric/virtual_object/reflection_point.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

enum class Solver : std::uint8_t { Explosion, Refined, Analytic, Layered, Subdivision };

using raster::VertexKind;

struct SolverOptions {
  int mapResolution = 256;        ///< pixels across the near and far map
  int hiddenMapResolution = 256;  ///< pixels across the hidden map
  int seedResolution = 128;       ///< pixels across the map of starting points of Refined
  /// On a convex mirror, how far the eye may go, as a share of its distance to the mirror, until near and far
  /// map are filled anew. Only for Refined, whose searches end in the one root wherever they begin.
  double mapsServeWithin = 0;
  int newtonSteps = 16;      ///< most evaluations of Refined; three are usual
  double longestStep = 0.7;  ///< of Refined, of the mesh's radius
  double tolerance = 1e-5;   ///< of Refined: sine of the angle between normal and half vector at J
};

/// Where the eye sees a scene point.
struct ReflectionPoint {
  dvec3 position{0};         ///< J
  dvec3 normal{0};           ///< unit
  dvec3 virtualPosition{0};  ///< Q'
  SurfacePoint at;           ///< J on ReflectorMesh::triangles()
  double residual = 0;       ///< sine of the angle between normal and half vector
  int steps = 0;             ///< evaluations of the mirror law
  VertexKind kind = VertexKind::None;
};

/// The part of it that every vertex needs.
struct VirtualVertex {
  dvec3 virtualPosition{0}, position{0};  ///< Q', J
  SurfacePoint at;
  int steps = 0;
  VertexKind kind = VertexKind::None;

  /// Itself, or None where it is not finite.
  [[nodiscard]] VirtualVertex checked() const {
    const dvec3 sum = virtualPosition + position;
    return std::isfinite(sum.x + sum.y + sum.z) ? *this : VirtualVertex{};
  }
};

/// Where compute() puts its answers; all spans but the last have equal length, the last may be empty.
struct VertexSink {
  std::span<const vec3> scenePoints;
  std::span<vec3> virtualPositions;
  std::span<VertexKind> kinds;
  std::span<vec3> reflectionPoints;
  LanePlaces* places = nullptr;

  void write(std::size_t i, const vec3& virtualPosition, const vec3& position, VertexKind kind) const {
    virtualPositions[i] = virtualPosition;
    kinds[i] = kind;
    if (!reflectionPoints.empty()) reflectionPoints[i] = position;
  }
  void write(std::size_t i, const VirtualVertex& vertex) const {
    const bool isUsable = vertex.kind != VertexKind::None;
    write(i, isUsable ? vec3(vertex.virtualPosition) : scenePoints[i],
          isUsable ? vec3(vertex.position) : scenePoints[i], vertex.kind);
  }
};

/// Searches that wait until eight of their kind are there (refined_in_lanes.cpp).
struct WaitingLanes {
  struct Queue {
    LaneGroup group;
    std::size_t count = 0;
  };
  Queue seen, unseen;  ///< in the last frame
  Queue stragglers;    ///< took longer than those beside them
};

class VirtualObjectSolver {
 public:
  /// `mesh` must outlive the solver. `farRadius` bounds the scene around mesh.centre() (points outside are
  /// served, less well seeded).
  VirtualObjectSolver(const ReflectorMesh& mesh, const dvec3& eye, double farRadius,
                      const SolverOptions& options = {});

  /// Rebuilds the maps for a new eye; allocates nothing (a finder may).
  void setEye(const dvec3& eye);

  /// What solvers other than Explosion and Refined ask; without one they reflect nothing. It is given the
  /// eye.
  void useFinder(std::unique_ptr<PointFinder> finder);
  [[nodiscard]] bool hasFinder() const { return finder_ != nullptr; }

  /// All spans have equal length, except that `reflectionPoints` (J, wanted by selectVirtualTriangles()) may
  /// be empty. Parallel, and for convex mirrors in the processor's vectors; the result does not depend on the
  /// number of threads. Positions of None are left as Q. Those without a bit in `mayReflect`
  /// (VertexRuns::findReflected(); empty for all ones) become None, their positions are not touched.
  /// `places`: where the same vertices were last seen in this mirror, of use when eye and vertices have moved
  /// little; they are updated.
  void compute(Solver solver, std::span<const vec3> scenePoints, std::span<vec3> virtualPositions,
               std::span<VertexKind> kinds, std::span<vec3> reflectionPoints = {},
               std::span<const VertexBits> mayReflect = {}, LanePlaces* places = nullptr) const;

  /// One point, for tests and picking; nothing when the kind would be None.
  [[nodiscard]] std::optional<ReflectionPoint> findReflectionPoint(Solver solver,
                                                                   const dvec3& scenePoint) const;

  /// False when the eye cannot see any front of the mirror: everything is None, skip the reflector.
  [[nodiscard]] bool canReflect() const { return canReflect_; }

  /// At every welded vertex of the mesh.
  [[nodiscard]] const ReflectedRays& reflectedRays() const { return rays_; }

  /// Holds every ray that leaves the mirror; of use where canReflect().
  [[nodiscard]] const ReflectedBeams& reflectedBeams() const { return beams_; }

  [[nodiscard]] const ReflectorMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const dvec3& eye() const { return eye_; }
  [[nodiscard]] const ExplosionMap& nearMap() const { return nearMap_; }
  [[nodiscard]] const ExplosionMap& farMap() const { return farMap_; }
  [[nodiscard]] const HiddenMap& hiddenMap() const { return hiddenMap_; }
  /// For finders; of use where canReflect().
  [[nodiscard]] EyeView eyeView() const;

 private:
  [[nodiscard]] VirtualVertex solve(Solver solver, const dvec3& scenePoint) const;
  [[nodiscard]] VirtualVertex solveExplosion(const dvec3& scenePoint, const dvec2& coords,
                                             double nearWeight) const;
  [[nodiscard]] VirtualVertex solveRefined(const dvec3& scenePoint, const SeedPixel& seed,
                                           double nearWeight) const;
  /// The search from where the vertex was seen before; nothing if that leads nowhere soon.
  [[nodiscard]] std::optional<VirtualVertex> solveFrom(const SurfacePoint& start,
                                                       const dvec3& scenePoint) const;
  [[nodiscard]] bool isPastBoundary(const SurfacePoint& at) const;
  /// Step 3 of Refined, as if the law were held.
  [[nodiscard]] VirtualVertex placeSearched(const SearchResult& found) const;
  [[nodiscard]] VirtualVertex placeUnreflected(const SearchResult& end, const dvec3& scenePoint) const;
  [[nodiscard]] bool doMapsServe(const dvec3& eye) const;
  void computeInOrder(const VertexSink& sink, std::span<const std::uint32_t> vertices) const;
  void computeInLanes(const VertexSink& sink, std::span<const std::uint32_t> vertices,
                      WaitingLanes& waiting) const;
  void finishLanes(const VertexSink& sink, WaitingLanes& waiting) const;
  void solveQueue(const VertexSink& sink, WaitingLanes::Queue& queue, WaitingLanes& waiting) const;
  void prefetch(const LanePlace& place) const;
  void hideGroup(const VertexSink& sink, LaneGroup& group) const;
  void conclude(const VertexSink& sink, const LaneGroup& group) const;
  void solveHard(const VertexSink& sink, std::size_t vertex) const;
  void prepareLanes();
  [[nodiscard]] VirtualVertex solveFound(const dvec3& scenePoint) const;
  [[nodiscard]] std::optional<ReflectionPoint> describeFound(const dvec3& scenePoint) const;
  [[nodiscard]] dvec2 computeCoords(const dvec3& scenePoint, double& nearWeight) const;
  [[nodiscard]] SurfacePoint findSeed(const SeedPixel& seed, double nearWeight) const;
  [[nodiscard]] std::optional<SurfacePoint> findHidingPoint(const dvec3& scenePoint, bool surely) const;
  [[nodiscard]] VirtualVertex mirrorHidden(const SurfacePoint& at, const dvec3& scenePoint) const;

  const ReflectorMesh* mesh_;
  dvec3 eye_{0};
  std::optional<dvec3> mapEye_;  ///< for which near and far map were filled
  double farRadius_ = 0, inverseNear_ = 0, layersPerInverse_ = 0;
  SolverOptions options_;
  bool canReflect_ = false;
  ExplosionMap nearMap_, farMap_;
  HiddenMap hiddenMap_;
  SeedMap seedMap_;
  MirrorPatches patches_;
  ReflectedBeams beams_;
  ReflectedRays rays_;
  std::vector<LaneTriangle> laneTriangles_;
  std::vector<std::int32_t> surelyHiding_;
  LaneView laneView_;
  MapScratch scratch_[3];
  std::unique_ptr<PointFinder> finder_;
};

}  // namespace catoptric::virtual_object
