// SPDX-License-Identifier: Apache-2.0
// A plane section through a mirror and an eye: the reflection subdivision as a map (Ofek & Rappoport 1998,
// figure 4), asked point by point, so it shows what the structure answers and not what a drawing of it would.
#pragma once

#include <span>

#include "catoptric/sketch/sketch.h"
#include "catoptric/virtual_object/reflection_subdivision.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::sketch {

/// A plane of space as a picture: `centre` in its middle, `right` and `up` unit and orthogonal, `width` world
/// units from edge to edge.
struct Section {
  dvec3 centre{0}, right{1, 0, 0}, up{0, 1, 0};
  double width = 1;
  int widthPx = 480, heightPx = 360;

  [[nodiscard]] dvec3 at(double xPx, double yPx) const {
    const double scale = width / widthPx;
    return centre + (xPx - 0.5 * widthPx) * scale * right + (0.5 * heightPx - yPx) * scale * up;
  }
  [[nodiscard]] dvec3 normal() const { return glm::cross(right, up); }
  [[nodiscard]] dvec3 project(const dvec3& point) const {
    return point - glm::dot(point - centre, normal()) * normal();
  }
  /// So far away that it sees the plane without perspective.
  [[nodiscard]] scene::CameraFrame makeCamera() const;
};

/// Through the eye, the mirror's centre and `sideways`: the eye left, the mirror in the middle. `width` 0:
/// twice what holds both.
[[nodiscard]] Section makeSection(const virtual_object::ReflectorMesh& mesh, const dvec3& eye,
                                  const dvec3& sideways, double width, int widthPx, int heightPx);

/// Reflected cells in light colours, hidden ones in dull ones, points in several reflected cells violet, the
/// darker the more, the unreflected region white.
[[nodiscard]] core::ImageRgba8 drawCells(const virtual_object::ReflectorMesh& mesh, const dvec3& eye,
                                         const Section& section);

/// The mirror's outline in the plane, black; reflected rays red, hidden rays blue of at most `mostRays` of
/// its points; where it turns away from the eye the bisecting ray Z, green. Rays that leave the plane are
/// drawn as they fall on it.
[[nodiscard]] Sketch sketchProfile(const virtual_object::ReflectorMesh& mesh, const dvec3& eye,
                                   const Section& section, int mostRays);

/// Blythe 1999, figure 61: of the profile's point nearest to `share` (0 to 1) along its front, the view ray
/// V, the reflected ray R up to the sphere of `map`, and the direction D from the sphere's centre.
[[nodiscard]] Sketch sketchMapping(const virtual_object::ReflectorMesh& mesh, const dvec3& eye,
                                   const virtual_object::ExplosionMap& map, const Section& section,
                                   double share);

/// Blythe 1999, figures 63 and 64: the direction in which both maps are asked about `point`, the planes that
/// they name, the point mirrored in each (orange near, violet far), what their blend gives (blue), and where
/// the virtual vertex belongs (green).
[[nodiscard]] Sketch sketchLookUp(const virtual_object::VirtualObjectSolver& solver, const dvec3& point,
                                  const Section& section, bool withFarMap);

}  // namespace catoptric::sketch
