// SPDX-License-Identifier: Apache-2.0
// What a mirror cannot reflect, told for many vertices at once (methods.md, section 1, culling): the rays
// that leave the mirror start in a ball and run in a cone of directions. Steps:
//   1. Once: the vertices of the tessellated objects in runs of equal length, and for each run the ball
//      around all triangles that have a corner in it. A run whose ball no ray meets can be left out: no
//      triangle that loses its corner could have been seen.
//   2. For each eye: the ball of the mirror's front, the cone of its reflected rays.
//   3. A ray meets a ball only if the angle from the cone's axis to the ball's centre, as seen from the
//      middle of the mirror, is at most the cone's half angle and what both balls together cover, asin((r +
//      R) / distance).
// Exact in the sense that nothing is lost; a mirror that reflects all around, as a whole sphere does, culls
// nothing. Cost: two square roots for each run.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

struct ReflectedCone {
  dvec3 centre{0};
  double radius = 0;  ///< of the ball in which the rays start
  dvec3 axis{0, 0, 1};
  double halfAngleRadians = 0;

  [[nodiscard]] bool mayMeet(const dvec3& ballCentre, double ballRadius) const;
};

/// World space. The mirror must have front-facing triangles.
[[nodiscard]] ReflectedCone makeReflectedCone(const ReflectorMesh& mesh, const ReflectedRays& rays);

/// Step 1. A run that no triangle uses has a negative radius.
class VertexRuns {
 public:
  VertexRuns(const raster::TessellatedObjects& objects, std::size_t runLength);

  struct Ball {
    dvec3 centre{0};
    double radius = -1;
  };
  [[nodiscard]] std::span<const Ball> balls() const { return balls_; }
  /// Vertices of the runs that have a 0 in `mayReflect`, which may be empty for all ones.
  [[nodiscard]] std::size_t countLeftOut(std::span<const std::uint8_t> mayReflect) const;

 private:
  std::size_t vertices_, runLength_;
  std::vector<Ball> balls_;
};

/// Step 3: 1 for each run that may be reflected. `coneFromWorld` is what takes the vertices to where the
/// mirror sees them, a product of reflections. Reuses the memory of `mayReflect`.
void findReflectedRuns(const VertexRuns& runs, const ReflectedCone& cone, const dmat4& coneFromWorld,
                       std::vector<std::uint8_t>& mayReflect);

}  // namespace catoptric::virtual_object
