// SPDX-License-Identifier: Apache-2.0
// Where the rays that leave a mirror can be, for culling (culling.h; methods.md, section 1). Steps:
//   1. Once for a mirror: its triangles in patches whose normals differ little.
//   2. For each eye: the rays that leave a patch are a beam. Nine planes hold it: eight touch the cone of its
//      directions all round, one lies across; each is moved until all of the patch is on its inner side.
//      What starts on the inner side of a plane and does not run towards it stays there.
// A patch whose rays spread over more than a half space has no planes, and its beam is everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// World axes. Inside: normal . point >= distance.
struct BeamPlane {
  vec3 normal{0};                                            ///< unit
  float distance = -std::numeric_limits<float>::infinity();  ///< metres; this one: everything is inside
};

/// All rays of a mirror, and hardly more. None: it reflects nothing.
struct ReflectedBeams {
  static constexpr std::size_t kPlanes = 9, kMost = 32;
  using Beam = std::array<BeamPlane, kPlanes>;

  std::vector<Beam> beams;  ///< at most kMost

  /// Does not lie on the outer side of a plane of every beam.
  [[nodiscard]] bool mayMeet(const core::Box& box) const;
};

/// Steps 1 and 2. Keeps its memory.
class MirrorPatches {
 public:
  explicit MirrorPatches(const ReflectorMesh& mesh);

  /// `mesh`: the one it was made of; `rays`: computeReflectedRays().
  void makeBeams(const ReflectorMesh& mesh, const ReflectedRays& rays, ReflectedBeams& out);

 private:
  /// The rays at a patch's vertices, around the mirror's centre, by coordinate; returns false if the eye sees
  /// nothing of it.
  bool gatherRays(const ReflectorMesh& mesh, const ReflectedRays& rays, std::size_t patch);
  [[nodiscard]] ReflectedBeams::Beam makeBeam() const;
  [[nodiscard]] bool isAllAround(const ReflectedBeams& beams) const;

  std::vector<std::uint32_t> triangles_;    ///< in the order of the patches
  std::vector<std::size_t> ends_;           ///< of the patches
  std::vector<std::uint32_t> gatheredFor_;  ///< by vertex: the last patch
  std::vector<float> origins_[3], directions_[3];
  vec3 sum_{0};        ///< of the directions
  float longest_ = 0;  ///< chord between two directions of a triangle
  dvec3 centre_{0};    ///< of the mirror
  double radius_ = 0;  ///< likewise
  float slack_ = 0;    ///< metres
};

/// What a perspective whose centre is `eye` shows in a rectangle, (0,0) the lower left pixel of the picture:
/// what a flat mirror does, for the mirrored eye. Reuses the memory of `out`.
void makePictureBeam(const dmat4& clipFromWorld, const dvec3& eye, const ivec2& sizePx,
                     const gl::Scissor& rectangle, ReflectedBeams& out);

/// Of a mirror that flat ones move the world for: `beamsFromWorld` is what takes vertices to where it sees
/// them, a product of reflections.
[[nodiscard]] ReflectedBeams moveToWorld(const ReflectedBeams& beams, const dmat4& beamsFromWorld);

}  // namespace catoptric::virtual_object
