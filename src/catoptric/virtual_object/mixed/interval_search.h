// SPDX-License-Identifier: Apache-2.0
// Where in a part of a mirror that is not convex does the eye see a scene point Q: once for each interval
// between focal distances (methods.md, section 1, "When is one virtual object enough?").
//
// In:  a part's mesh, the eye, scene points (world).
// Out: for each interval wanted, virtual vertices of their own: J is accepted for interval i only if i foci
// of
//      the rays that leave the mirror around J lie between J and Q. So a point may have an image in each.
// Steps:
//   1. For an eye: rays from some hundred places of the part that the eye sees, each with what becomes of its
//      neighbours (J_u, J_v, r_u, r_v) and its focal distances.
//   2. For a point: the place on each ray nearest to it says in which interval the ray would show it, and
//      Q - J - t r = du (J_u + t r_u) + dv (J_v + t r_v), by least squares, how far along the mirror. The
//      nearest ray of each interval is where its search begins: eight rays side by side, in float.
//   3. Newton on the mirror law (reflection_point.h), then the interval is asked again at J.
//   4. Q' on the ray E -> J at |EJ| + |JQ|. J past the part's edge: doubly virtual.
// Departures: explosion maps (methods.md, section 1, item 4) hold one place for a direction and a radius;
// where the rays cross they hold the one filled last. Rays need no maps, which every eye would have to fill.
// Known failures: two reflections of a point in one interval of a part: the nearer to a ray is found. Points
// that the mirror hides have none. Cost: about 1 us a point.
// Source: as above; rays for seeds as in the implicit reflectors' search.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/raster/virtual_triangles.h"
#include "catoptric/virtual_object/culling.h"
#include "catoptric/virtual_object/mixed/focal_distances.h"

namespace catoptric::virtual_object {

/// Parallel to the scene points. Positions of None are left as they are.
struct IntervalVertices {
  std::vector<vec3> positions, reflectionPoints;  ///< Q', J
  std::vector<std::uint32_t> triangles;           ///< of the mesh, with J
  std::vector<raster::VertexKind> kinds;
};

class IntervalSearch {
 public:
  /// The mesh must outlive it.
  IntervalSearch(const ReflectorMesh& mesh, const dvec3& eye);
  /// Step 1.
  void setEye(const dvec3& eye);
  [[nodiscard]] const dvec3& eye() const { return eye_; }
  /// False when the eye cannot see any front of the part.
  [[nodiscard]] bool canReflect() const { return !triangles_.empty(); }
  /// Holds every ray that leaves the part; of use where canReflect().
  [[nodiscard]] const ReflectedBeams& reflectedBeams() const { return beams_; }

  /// Those without a bit in `mayReflect` (VertexRuns::findReflected(); empty for all ones)
  /// become None. Of intervals that are not wanted nothing is written. Parallel; the result does not depend
  /// on the number of threads.
  void compute(std::span<const vec3> scenePoints, std::span<const VertexBits> mayReflect,
               const std::array<bool, kIntervals>& wanted,
               std::array<IntervalVertices, kIntervals>& found) const;

  /// J of one point in one interval; nothing where there is none, or where it lies past the part's edge.
  [[nodiscard]] std::optional<dvec3> find(const dvec3& scenePoint, std::size_t interval) const;

  /// Eight rays, by coordinate: J relative to the part's centre, unit direction r, and their changes along
  /// both edges of the triangle.
  struct alignas(32) RayGroup {
    float origin[3][8], direction[3][8], originU[3][8], originV[3][8], directionU[3][8], directionV[3][8];
    float focus1[8], focus2[8];
  };
  /// Of one point and interval: the nearest ray, and how far it is from showing the point, squared.
  struct Start {
    std::uint32_t ray = 0;
    float squared = 0;
  };
  /// Step 2. `point`: relative to the part's centre.
  static void findStarts(std::span<const RayGroup> groups, const vec3& point,
                         std::array<Start, kIntervals>& starts);

 private:
  void storeRay(const MirrorTriangle& triangle, std::size_t lane, RayGroup& group) const;
  struct Vertex {
    vec3 position{0}, reflectionPoint{0};
    std::uint32_t triangle = 0;
    raster::VertexKind kind = raster::VertexKind::None;
  };
  [[nodiscard]] Vertex search(std::uint32_t triangle, const dvec3& scenePoint, std::size_t interval) const;

  const ReflectorMesh* mesh_;
  dvec3 eye_{0};
  ReflectedRays rays_;
  MirrorPatches patches_;
  ReflectedBeams beams_;
  std::vector<RayGroup> groups_;
  std::vector<std::uint32_t> triangles_;  ///< of the rays
};

/// Triangles of which every corner has an image in the interval: 1, else 0.
void markIntervalTriangles(const raster::TessellatedObjects& objects, const IntervalVertices& vertices,
                           std::vector<std::uint8_t>& isKept);

}  // namespace catoptric::virtual_object
