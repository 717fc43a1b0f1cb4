// SPDX-License-Identifier: Apache-2.0
// Question: which way of drawing a mirror is the cheapest whose expected error stays under --max-error?
//
// In:  the scene's triangles, a mirror, a camera (world, pixels).
// Out: every way that there is, with the error and the time expected of it, and which one is picked and why.
// Steps:
//   1. Flat: mirrored. A refractor: solver exact, the only one that knows Snell's law. Nothing to choose.
//   2. A curved mirror of fewer than kFewPixels: an environment map of few texels. No error there is wider
//      than the mirror (2004, section 7: small parts fall back to the map).
//   3. Else three ways, each with its error (expected_error.h) and its time (expected_cost.h): an environment
//      map; refined, by one virtual object on a convex mirror and by parts elsewhere; exact.
//   4. The cheapest of those whose error is within the bound. While the eye moves, the last frame's way is
//      kept until its error is past the bound or another one is cheaper by kWorthIt and, a map, by kMargin of
//      the bound within it: no flicker, and what is kept is within the bound, too.
// Departures: 2004 sends chaotic parts to the map. Exact does not ask how many reflections a point has; parts
//      where rays are all but random cost it no more than others (mixed/README.md), and a map is wrong there.
// Where it is asked: for mirrors seen directly, in scenes in which nothing has moved. A mirror in a mirror,
// and every mirror once something has moved, is drawn as its shape says: refined if convex, else exact.
// Cost: about 1 ms a mirror and place of the eye (docs/decisions.md, "What auto picks").
// Source: methods.md, section 1; our own.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>

#include "catoptric/raster/levels_of_detail.h"
#include "catoptric/renderer/expected_cost.h"
#include "catoptric/renderer/frame.h"

namespace catoptric::renderer {

/// `auto` draws curved mirrors of fewer pixels by environment maps of few texels, in scenes that do not move.
inline constexpr int kFewPixels = 16;

/// `auto` tessellates what it reflects as if --max-error were no more than this: beyond, little time is saved
/// and triangles are lost (virtual_object/README.md has the table).
inline constexpr double kCoarsestPx = 4;

struct ChoiceOptions {
  double maxErrorPx = 0.5;
  int bounces = 1;
  bool boxCorrected = true;
  int mapTexels = 512;
  const raster::LevelsOfDetail* levels = nullptr;  ///< of the scene, where they have been made
  /// For a frame: kFewPixels or more were counted, whatever samples say, and what cannot be picked need not
  /// be known. An error past the bound is then only known to be past it.
  bool isForFrame = false;
  bool operator==(const ChoiceOptions&) const = default;
};

/// What `auto` picks for mirrors of a scene in a view. Keeps what depends on a mirror alone; the geometry
/// must not change, and it and the triangles (scene::listTriangles(), of all parts) must outlive the object.
class MethodChooser {
 public:
  MethodChooser(const scene::WorldGeometry& geometry, const geometry::TriangleHierarchy& triangles);
  ~MethodChooser();
  /// `reflector`: index into the geometry's. `last`: what was chosen for the frame before, if there was one.
  [[nodiscard]] MethodChoice choose(std::uint32_t reflector, const scene::CameraFrame& camera,
                                    const ChoiceOptions& options, const MethodChoice* last = nullptr);

 private:
  struct Mirror;
  [[nodiscard]] Mirror& findMirror(std::uint32_t reflector, const dvec3& eye);
  [[nodiscard]] double findTriangles(Mirror& mirror, const scene::CameraFrame& camera,
                                     const ChoiceOptions& options) const;
  [[nodiscard]] ViewForecast forecastParts(Mirror& mirror, const scene::CameraFrame& camera,
                                           const ChoiceOptions& options,
                                           const virtual_object::SceneRays& rays, MirrorLoad& load) const;
  void addCandidates(Mirror& mirror, const scene::CameraFrame& camera, const ChoiceOptions& options,
                     MethodChoice& choice) const;

  const scene::WorldGeometry& geometry_;
  const geometry::TriangleHierarchy& triangles_;
  std::map<std::pair<std::uint32_t, bool>, std::unique_ptr<Mirror>> mirrors_;  ///< by side that is seen
};

/// Step 4, of candidates that are not empty: an index. `last`: of the frame before, or null.
[[nodiscard]] std::size_t pickCandidate(std::span<const MethodCandidate> candidates, double maxErrorPx,
                                        const MethodChoice* last);

}  // namespace catoptric::renderer
