// SPDX-License-Identifier: Apache-2.0
// The search of reflection_point.h for eight vertices side by side, in float.
//
// Question: where on a convex mirror does the eye see each of eight scene points?
//   1. Start: where the last frame found it; else the blend of what the near and the far explosion map say,
//      in the triangle that the hidden map shows there.
//   2. All lanes are evaluated at once (mirror_law_lanes.h). A lane whose residual is small takes one last
//      step and is found: Newton's error goes with the square, so the step makes it vanish. Another takes its
//      step and goes on; a step that made it worse is taken back and a shorter one taken.
//   3. Steps that leave their triangle walk over the mesh, lane by lane (mesh_walk.h); past the end of an
//      open mirror the last triangle is extrapolated.
//   4. Three ends say that nothing is reflected: the mirror's back, at a root or for long; the place where
//      the ray to the point goes straight into the mirror, where h vanishes; too many steps far outside. In
//      the next frame it is asked first whether the ray enters the triangle that hid the point, or whether
//      the law fails there as it did; if neither, the search begins anew.
//   5. What is not easy - nearly touching the mirror, grazing, no quick convergence - is handed back for the
//      double search. So what is found, and for which vertices, is what that one finds. A point that lies on
//      the mirror, to within what floats tell, is seen where it is: the law has no meaning there.
// The few lanes that take longer than the others of their group can be moved to another one and go on there.
//
// Frame inside: world axes, origin at the mirror's centre. Loss against the double search: less than 0.05 px
// where the mirror is 700 px wide (lanes_test.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

inline constexpr int kLanes = 8;
using LaneFloats = float[kLanes];

/// A triangle of the mirror as the lanes read it: three vectors, and one number more. Meanings as in
/// MirrorTriangle.
struct alignas(64) LaneTriangle {
  vec3 position0, edge1, edge2, normal0, normal1, normal2;
  float gram11, gram12, gram22;
  std::array<std::uint32_t, 3> neighbours;
  std::uint32_t flags;
};

[[nodiscard]] std::vector<LaneTriangle> makeLaneTriangles(const ReflectorMesh& mesh);

/// A map of directions, as floats around the mirror's centre.
struct LaneMap {
  vec3 centre{0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  vec2 lower{0}, pixelsPerUnit{1};
  int size = 0;
};

/// What the lanes read of a mirror and an eye. The spans must outlive it.
struct LaneView {
  std::span<const LaneTriangle> triangles;
  vec3 centre{0}, centreRest{0};  ///< of the mirror, world: a float, and what it leaves
  vec3 eye{0};
  LaneMap hiddenMap, seedMap;
  std::span<const std::uint32_t> hiddenIds;
  std::span<const std::int32_t> surelyHiding;  ///< findSurelyHiding()
  std::span<const SeedPixel> seeds;
  float hiddenNearest = 0, hiddenSquaredCosine = 2;
  float inverseNear = 0, layersPerInverse = 0;
  float touching = 0;     ///< nearer points need doubles
  float contact = 0;      ///< unless they are this near: then they are on the mirror
  float longestStep = 0;  ///< on the mirror
};

/// Where the last search of a vertex ended. A place that is not on the mirror at all is as good as none; one
/// that is wrong costs an evaluation.
struct LanePlace {
  std::int32_t triangle = -1;  ///< -1: there was none
  float u = 0, v = 0;
  /// 0, or by how much the law failed where it gave up: the half vector's part across the normal, < 0 on the
  /// mirror's back.
  float lostBy = 0;

  [[nodiscard]] bool isSeen() const { return triangle >= 0 && lostBy == 0; }
};
using LanePlaces = std::vector<LanePlace>;

/// How far a search has come: the last step, from where, and how good it was there.
struct LaneState {
  std::int32_t triangle[kLanes];
  LaneFloats u, v, stepU, stepV, merit;
  std::int32_t steps[kLanes], stepsOutside[kLanes], shortened[kLanes];
};

/// Eight vertices. Which ones: bit i for lane i.
struct alignas(64) LaneGroup {
  unsigned wanted = 0;            ///< in: to be searched
  std::size_t vertex[kLanes];     ///< the caller's
  LaneFloats point[3];            ///< in: Q, world
  std::int32_t triangle[kLanes];  ///< in: as LanePlace; out: where the search stands
  LaneFloats u = {}, v = {};
  LaneFloats lostBy = {};  ///< in: as LanePlace; out: of those in `lost`
  bool hasBegun = false;   ///< in: searchLanes() left it before it was ready
  LaneState state;         ///< if so

  unsigned hidden = 0;  ///< out of hideLanes(): mirrored where the mirror hides them

  // Out of searchLanes(): each wanted lane is in one of the first four.
  unsigned found = 0;
  unsigned lost = 0;       ///< has no root: straight through the mirror, on its back, or far past its edge
  unsigned hard = 0;       ///< for the double search
  unsigned goesOn = 0;     ///< not ready yet
  unsigned isOutside = 0;  ///< of those found, past the mirror's edge
  LaneFloats virtualPosition[3], position[3];  ///< Q', J, world
};

/// By pixel of a hidden map: its triangle where the pixels around it have one, too; -1 elsewhere.
void findSurelyHiding(const core::Image<std::uint32_t>& ids, std::vector<std::int32_t>& surelyHiding);

/// Finds the wanted lanes that the mirror surely hides, and their places, as `hidden`.
void hideLanes(const LaneView& view, LaneGroup& group);

/// Until at most `fewest` lanes go on. What becomes of a lane depends on no other one. Overwrites places of
/// lanes that are not wanted.
void searchLanes(const LaneView& view, LaneGroup& group, int fewest);

/// A search to another group, `wanted` left out.
void moveLane(const LaneGroup& from, std::size_t i, LaneGroup& to, std::size_t j);

/// The law at one place each, for tests.
struct LaneLaw {
  LaneFloats squaredSine;   ///< of the angle between half vector and normal
  LaneFloats facing;        ///< h.n; > 0 where E and Q lie in front
  LaneFloats distance;      ///< |JQ|
  LaneFloats stepU, stepV;  ///< Newton's step; not finite where the two equations are dependent
};
/// Of the group, places and points are read.
[[nodiscard]] LaneLaw evaluateLanes(const LaneView& view, const LaneGroup& group);

}  // namespace catoptric::virtual_object
