// SPDX-License-Identifier: Apache-2.0
// Question: how many pixels off would an environment map show things in a mirror, in the words of
// metrics/displacement.h, before anything is drawn?
//
// In:  samples of the mirror (virtual_object/mixed/mirror_samples.h), what the map would show along each
//      sample's ray (environment_map/map_view.h), the scene's triangles. World space, pixels.
// Out: the 95th percentile of the displacement over the mirror's pixels and over those that show objects.
// Steps, for a sample at J:
//   1. Its ray meets the point that the truth shows; the map shows the point X.
//   2. Where does the mirror show X? Newton's search for the reflection point J' from J on. If there is none,
//      if something stands between J' and X that a pixel tells from X, or X lies on a mirror that is
//      followed, X is seen nowhere: lost, which counts as kLostPx.
//   3. The displacement is the distance of J and J' on the screen, and half a texel of the map as it is seen
//      there.
//   4. The sample counts among object pixels where the truth or the map shows neither sky nor shell.
// Departures: cut-out textures are not asked for, and a thing that a mirror shows twice is found once. What
// changes with the place of the eye besides place, highlights, no displacement tells.
// Known failures: where about 5 % of the samples are lost the percentile stands on a cliff: balls of
//      reflector-sweep and object-sweep are expected to be at 14 to 20 px and measured at 24.
// Cost: three rays and a search a sample, about 4 us; where the bound is passed early, a tenth of that.
#pragma once

#include <cstdint>
#include <span>

#include "catoptric/environment_map/map_view.h"
#include "catoptric/virtual_object/mixed/mirror_samples.h"

namespace catoptric::renderer {

inline constexpr double kLostPx = 24;  ///< metrics::kLostPx, which the renderer does not see

/// 95th percentiles, pixels; 0 where there are no such pixels.
struct MapError {
  double mirrorPx = 0, objectPx = 0;
  bool isAtLeast =
      false;  ///< more of the samples were past the bound than could be: the others were not asked

  [[nodiscard]] double worstPx() const { return mirrorPx > objectPx ? mirrorPx : objectPx; }
};

/// What the error is asked for. All of it must outlive the call only.
struct MapErrorQuery {
  const scene::WorldGeometry& world;
  std::uint32_t reflector;
  const virtual_object::ReflectorMesh& mesh;
  const virtual_object::SceneRays& scene;
  const environment_map::MapView& map;
  const scene::CameraFrame& camera;
  int mapTexels = 512;  ///< edge of a cube face
  int bounces = 1;      ///< of the frame: from 2 on, mirrors in the mirror are followed, which a map does not
};

/// Stops where it is sure that the percentile is past `stopBeyondPx`.
[[nodiscard]] MapError expectMapError(const MapErrorQuery& query,
                                      std::span<const virtual_object::MirrorSample> samples,
                                      double stopBeyondPx);

}  // namespace catoptric::renderer
