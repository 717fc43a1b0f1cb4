// SPDX-License-Identifier: Apache-2.0
// What a user can choose about depth-preserving reflection maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace catoptric::depth_reflection_map {

/// How many pixels a zexel fills: one, 3x3, or those within its own footprint.
enum class Splat : std::uint8_t { Point, Square, Footprint };
/// Which of two zexels a pixel shows: the later in occlusion-compatible order, or the nearer.
enum class Visibility : std::uint8_t { Ordered, ZBuffer };

struct ZexelOptions {
  int hemisphere = 64;  ///< reference images on a hemisphere behind a mirror
  int size = 512;       ///< zexels along the longer side of a reference image
  int references = 2;   ///< warped for each mirror and frame, 1 or 2
  Splat splat = Splat::Footprint;
  Visibility visibility = Visibility::Ordered;
  bool isHierarchical = true;     ///< fewer zexels for a mirror that is small on screen
  bool skipsRegions = true;       ///< leaves out zexels that cannot land in the mirror's image
  bool isCoherent = true;         ///< uncovered pixels keep what they showed in the last frame
  bool continuesSurfaces = true;  ///< exposures show what lies behind their edges, continued
  bool marksExposures = false;    ///< instead of both: they are magenta
  std::size_t maxBytes = std::size_t(512) << 20;  ///< of all reference images together
  std::string cacheFile{};                        ///< of reference images, read at the start; empty: none

  bool operator==(const ZexelOptions&) const = default;
};

}  // namespace catoptric::depth_reflection_map
