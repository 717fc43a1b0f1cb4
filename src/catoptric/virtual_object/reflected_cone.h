// SPDX-License-Identifier: Apache-2.0
// What a mirror cannot reflect, told for many vertices at once (methods.md, section 1, culling): the rays
// that leave the mirror start in a ball and run in a cone of directions. Steps:
//   1. Once: the vertices of the tessellated objects in runs of equal length, and for each run the ball
//      around all triangles that have a corner in it. A run whose ball no ray meets can be left out: no
//      triangle that loses its corner could have been seen.
//   2. For each eye: the ball of the mirror's front, the cone of its reflected rays, and in it the pyramid of
//      four planes that lie closer, for most mirrors are not round.
//   3. A ray meets a ball only if the angle from the cone's axis to the ball's centre, as seen from the
//      middle of the mirror, is at most the cone's half angle and what both balls together cover, asin((r +
//      R) / distance), and if the ball reaches as near as R to the inner side of all four planes.
// Exact in the sense that nothing is lost; a mirror that reflects all around, as a whole sphere does, culls
// nothing. Cost: two square roots for each run.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

struct ReflectedCone {
  dvec3 centre{0};
  double radius = 0;  ///< of the ball in which the rays start
  dvec3 axis{0, 0, 1};
  double halfAngleRadians = 0;
  std::optional<std::array<dvec3, 4>> sides;  ///< normals, inwards, of planes through the centre; none: wide

  [[nodiscard]] bool mayMeet(const dvec3& ballCentre, double ballRadius) const;
};

/// World space. The mirror must have front-facing triangles.
[[nodiscard]] ReflectedCone makeReflectedCone(const ReflectorMesh& mesh, const ReflectedRays& rays);

/// What a perspective whose centre is `eye` shows in a rectangle, (0,0) the lower left pixel of the picture:
/// what a flat mirror does, for the mirrored eye.
[[nodiscard]] ReflectedCone makePictureCone(const dmat4& clipFromWorld, const dvec3& eye, const ivec2& sizePx,
                                            const gl::Scissor& rectangle);

/// A radius below 0: there is nothing in it.
struct Ball {
  dvec3 centre{0};
  double radius = -1;
};

/// Step 1. A run that no triangle uses has a negative radius.
class VertexRuns {
 public:
  VertexRuns(const raster::TessellatedObjects& objects, std::size_t runLength);

  [[nodiscard]] std::span<const Ball> balls() const { return balls_; }
  /// Vertices of the runs that have a 0 in `mayReflect`, which may be empty for all ones.
  [[nodiscard]] std::size_t countLeftOut(std::span<const std::uint8_t> mayReflect) const;

 private:
  std::size_t vertices_, runLength_;
  std::vector<Ball> balls_;
};

/// Triangles in runs: a whole run that no ray meets need not be looked at.
class TriangleRuns {
 public:
  /// Three indices for each triangle.
  TriangleRuns(std::span<const vec3> positions, std::span<const std::uint32_t> indices);

  /// By triangle: 0 in runs that the cone does not meet, 1 in the others. How many triangles those have.
  /// `coneFromWorld`: see findReflectedRuns().
  std::size_t mark(const ReflectedCone& cone, const dmat4& coneFromWorld,
                   std::vector<std::uint8_t>& mayMeet) const;

 private:
  std::size_t triangles_;
  std::vector<Ball> balls_;
};

/// Step 3: 1 for each run that may be reflected. `coneFromWorld` is what takes the vertices to where the
/// mirror sees them, a product of reflections. Reuses the memory of `mayReflect`.
void findReflectedRuns(const VertexRuns& runs, const ReflectedCone& cone, const dmat4& coneFromWorld,
                       std::vector<std::uint8_t>& mayReflect);

}  // namespace catoptric::virtual_object
