// SPDX-License-Identifier: Apache-2.0
// What virtual objects can be expected to get right of a mirror in a view, and what they would cost, before
// anything is drawn (methods.md, section 1, "When is one virtual object enough?").
//
// In:  a mirror cut into parts, the scene's triangles, the eye (world).
// Out: for each part its size on the screen and what of it each interval between focal distances shows.
// Steps:
//   1. Some hundred triangles of each part that the eye sees the front of, weighted by their size on the
//      screen.
//   2. The focal distances along the triangle's reflected ray (focal_distances.h).
//   3. What does that ray meet, and where? It may be the mirror itself: no virtual object shows that.
//   4. A sample is one-to-one where the thing is farther than kNearFocus of each root away from it. Samples
//      are grouped by how many roots lie before the thing: its interval. Each gets a virtual object of its
//      own (interval_search.h), because what lies in another interval has another reflection point.
//   5. Does the search find its way back? From what the ray meets to where it left, in its interval: a point
//      may have other reflections in the same part, and a vertex gets one.
// Departures: mirrors that hide each other, and the picture's frame, are not asked for.
// Cost: about 2 us a sample.
// Source: methods.md; focal distances as of any two-parameter family of rays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/virtual_object/mixed/focal_distances.h"
#include "catoptric/virtual_object/mixed/mirror_parts.h"

namespace catoptric::virtual_object {

struct PartForecast {
  double pixels = 0;                        ///< of its front, as seen without anything before it
  std::array<double, kIntervals> shares{};  ///< of them, by interval (step 4), 0 to 1
  double self = 0;                          ///< share that shows the mirror itself
  double nearFocus = 0;                     ///< share that shows something near a focus
  double notFound = 0;                      ///< share of the intervals' that step 5 does not find

  [[nodiscard]] double oneToOne() const { return shares[0] + shares[1] + shares[2]; }
  /// Would virtual objects be right almost everywhere? Where the mirror itself is seen they are not, nor
  /// where searches lead elsewhere.
  [[nodiscard]] bool suitsVirtualObjects() const {
    return nearFocus <= 0.05 && notFound <= 0.03 && self <= 0.01;
  }
  /// Is the interval worth a virtual object of its own? What is left out may be hidden by what is not.
  [[nodiscard]] bool shows(std::size_t interval) const {
    return suitsVirtualObjects() && shares[interval] >= 0.002;
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

/// Expected costs, ms on the machine of the README, of a part's virtual objects and of solver `exact` at the
/// pixels that they would show. Fitted by hand to `bench --methods virtual-refined,virtual-exact` on the
/// built-in scenes; of use to compare, not to predict.
struct PartCosts {
  double virtualMs = 0, boundMs = 0;
};
[[nodiscard]] PartCosts expectCosts(const PartForecast& forecast, Bend bend, std::size_t vertices);

/// Which parts get virtual objects, one for each interval that they show: where those are right, and (unless
/// `all`) faster, together by what it takes to draw in parts at all.
[[nodiscard]] std::vector<std::uint8_t> chooseParts(std::span<const MirrorPart* const> parts,
                                                    std::span<const PartForecast> forecasts,
                                                    std::size_t vertices, bool all);

}  // namespace catoptric::virtual_object
