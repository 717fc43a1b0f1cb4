// SPDX-License-Identifier: Apache-2.0
// Where reference images are taken (Bastos & Stuerzlinger 1998, section 4): through the mirror as through a
// window, from points of a hemisphere behind it.
//
// The image plane of a reference is the mirror's own plane, cut out around the mirror's outline. So zexels
// lie evenly on the mirror from wherever it is looked through, what is behind the mirror is cut off exactly
// by the near plane, and the disparity of eq. 4 with far = infinity is near / depth with near = the distance
// of the plane: 1 on the mirror, 0 at the sky.
#pragma once

#include <vector>

#include "catoptric/raster/surface_pass.h"

namespace catoptric::depth_reflection_map {

/// A flat mirror as a window: points are centre + x right + y up, metres.
struct MirrorWindow {
  dvec3 centre{0};
  dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};  ///< unit; forward points to the bright side
  dvec2 half{0.5, 0.5};                                 ///< half the sizes of the outline's rectangle
};

/// Window of a planar reflector; `brightSide` 1 or -1 picks the side of its plane that is shown.
[[nodiscard]] MirrorWindow makeMirrorWindow(const scene::WorldGeometry& world, std::uint32_t reflector,
                                            double brightSide);

/// A reference image: zexel (x, y), disparity d shows centre + worldFromZexel (x, y, 1) / d. Coordinates are
/// zexels from the lower left corner; the first zexel's middle is (0.5, 0.5).
struct ReferenceCamera {
  dvec3 centre{0};
  dmat3 worldFromZexel{1.0};
  dvec3 forward{0, 0, 1};
  double planeDistance = 1;  ///< of the image plane, metres
  int width = 0, height = 0;

  /// How to draw it.
  [[nodiscard]] raster::PinholeView makeView() const;
};

/// Looks from `centre` (behind the window) through the window, which is widened by `margin` metres.
[[nodiscard]] ReferenceCamera makeReferenceCamera(const MirrorWindow& window, const dvec3& centre,
                                                  double margin, int size);

/// Where images of one distance are taken from.
struct Hemisphere {
  std::vector<dvec3> centres;
  double spacing = 0;  ///< about, between neighbours, metres
};

/// `count` points spread evenly over the hemisphere of a radius behind the window, none nearer to its plane
/// than a tenth of the radius; or over that part of it where a mirrored eye can be when the eye itself stays
/// within `room`. Where less than a hundredth of the hemisphere belongs to it, or `room` is null, over all of
/// it.
[[nodiscard]] Hemisphere makeHemisphere(const MirrorWindow& window, double radius, int count,
                                        const core::Box* room = nullptr);

}  // namespace catoptric::depth_reflection_map
