// SPDX-License-Identifier: Apache-2.0
// What virtual objects can be expected to get right of a mirror in a view, and what they would cost, before
// anything is drawn (methods.md, section 1, "When is one virtual object enough?").
//
// In:  a mirror cut into parts, the scene's triangles, the eye (world).
// Out: for each part its size on the screen and the share of it whose reflection is one-to-one.
// Steps:
//   1. Some hundred triangles of each part that the eye sees the front of, weighted by their size on the
//      screen.
//   2. X(u, v, t) = J + t r over such a triangle: det[J_u + t r_u, J_v + t r_v, r] is a quadratic in t; its
//      positive roots are the focal distances along the triangle's reflected ray.
//   3. What does that ray meet, and where? It may be the mirror itself: no virtual object shows that.
//   4. A sample is one-to-one where the thing is farther than kNearFocus of each root away from it. Samples
//      are grouped by how many roots lie before the thing; the largest group is what one virtual object can
//      show, because what lies in another interval has another reflection point, which a search does not find
//      at the same time.
// Departures: mirrors that hide each other, and the picture's frame, are not asked for.
// Cost: about 2 us a sample.
// Source: methods.md; focal distances as of any two-parameter family of rays.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/virtual_object/mixed/mirror_parts.h"

namespace catoptric::virtual_object {

/// The rays that leave a mirror triangle around a point of it, as X = J + t r: the area that they go through,
/// for the parallelogram of the triangle's edges, is a quadratic in the distance t.
struct Pencil {
  double c0 = 0, c1 = 0, c2 = 0;
  [[nodiscard]] double areaAt(double t) const { return c0 + t * (c1 + t * c2); }  ///< signed
};
[[nodiscard]] Pencil findPencil(const MirrorTriangle& triangle, const dvec3& eye, double u = 1.0 / 3,
                                double v = 1.0 / 3);

/// Distances at which the rays reflected by a triangle come to a focus; ascending, infinite where there is
/// none.
[[nodiscard]] std::array<double, 2> findFocalDistances(const MirrorTriangle& triangle, const dvec3& eye);

struct PartForecast {
  double pixels = 0;     ///< of its front, as seen without anything before it
  double oneToOne = 0;   ///< share of them in the largest group of step 4, 0 to 1
  double self = 0;       ///< share that shows the mirror itself
  double nearFocus = 0;  ///< share that shows something near a focus

  /// Would a virtual object be right almost everywhere? A search that starts from near and far maps finds
  /// both sides of a hollow's focus, if one of them is all but everything; what lies at it, or is hidden by
  /// the mirror itself, it does not.
  [[nodiscard]] bool suitsVirtualObject() const {
    return oneToOne >= 0.9 && nearFocus <= 0.03 && self <= 0.01;
  }
};

/// What rays may meet. `triangles`: with geometry::kTwoSided in the flags, `triangle` an index into `parts`.
struct SceneRays {
  const geometry::TriangleHierarchy& triangles;
  std::span<const std::uint32_t> parts;
  std::uint32_t ownPart;  ///< the mirror's
};

/// Parallel to `parts`. `pixelsPerTangent`: of the camera, pixels of a tangent of 1.
[[nodiscard]] std::vector<PartForecast> forecastView(std::span<const MirrorPart* const> parts,
                                                     const SceneRays& scene, const dvec3& eye,
                                                     double pixelsPerTangent);

/// Expected costs, ms on the machine of the README, and what is cheaper for a part. Fitted by hand to
/// `bench --methods virtual-refined,virtual-exact` on the built-in scenes; of use to compare, not to predict.
struct PartCosts {
  double virtualMs = 0, boundMs = 0;
};
[[nodiscard]] PartCosts expectCosts(const PartForecast& forecast, Bend bend, std::size_t vertices,
                                    std::size_t mirrorTriangles);

}  // namespace catoptric::virtual_object
