// SPDX-License-Identifier: Apache-2.0
// The mirror law and Newton's step of reflection_point.h for eight vertices at once, in float.
//
// Question: the same as there, for vertices for which it is easy: eight searches go on side by side, each in
// a lane of its own, and one call evaluates all of them in the widest vectors that the processor has.
//
// Frame: world axes, origin at the mirror's centre, so that floats carry the accuracy where it counts.
// Loss against the double search: less than 0.05 px where the mirror is 700 px wide (lanes_test.cpp). What
// floats cannot do (points that nearly touch the mirror, grazing ones, searches that do not converge at
// once) is not tried here: the caller gives it to the double search.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

inline constexpr int kLanes = 8;

/// A triangle of the mirror as the lanes read it: two cache lines. Meanings as in MirrorTriangle.
struct alignas(64) LaneTriangle {
  vec3 position0, edge1, edge2, normal0, normal1, normal2;
  float gram11, gram12, gram22;
  std::array<std::uint32_t, 3> neighbours;
  std::uint32_t flags;
};

[[nodiscard]] std::vector<LaneTriangle> makeLaneTriangles(const ReflectorMesh& mesh);

/// Structure of arrays: element i of each array belongs to lane i.
struct alignas(64) Lanes {
  using Floats = float[kLanes];
  // In.
  Floats position0[3], edge1[3], edge2[3], normal0[3], normal1[3], normal2[3];
  Floats u, v;      ///< where on its triangle each search stands
  Floats point[3];  ///< Q
  // Out.
  Floats squaredSine;   ///< of the angle between half vector and normal
  Floats facing;        ///< h.n; > 0 where E and Q lie in front
  Floats distance;      ///< |JQ|
  Floats stepU, stepV;  ///< Newton's step; not finite where the two equations are dependent

  void setTriangle(int lane, const LaneTriangle& triangle);
  void setPoint(int lane, const vec3& q) {
    for (int k = 0; k < 3; ++k) point[k][lane] = q[k];
  }
};

/// Evaluates all lanes for an eye.
void evaluateLanes(Lanes& lanes, const vec3& eye);

/// The hidden map's frame, as floats around the mirror's centre.
struct LaneView {
  vec3 eye{0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  vec2 lower{0}, pixelsPerUnit{1};
  float nearest = 0, squaredCosine = 2;

  /// Pixel of the hidden map in which the eye sees a point.
  [[nodiscard]] vec2 pixelOf(const vec3& local) const {
    const vec3 d = local - eye;
    const float length = std::sqrt(glm::dot(d, d));
    const float scale = 1.0f / std::sqrt(2.0f * length * (glm::dot(z, d) + length));
    return (vec2(glm::dot(x, d), glm::dot(y, d)) * scale - lower) * pixelsPerUnit;
  }
};

/// A point of the mirror, as SurfacePoint.
struct LanePoint {
  std::uint32_t triangle = 0;
  float u = 0, v = 0;
};

/// Moves a point by (du, dv) of its triangle, across edges as they come. False where that is not done within
/// a few triangles or leads past the end of the mesh.
[[nodiscard]] bool walkLane(std::span<const LaneTriangle> triangles, LanePoint& at, float du, float dv);

}  // namespace catoptric::virtual_object
