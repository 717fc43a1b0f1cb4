// SPDX-License-Identifier: Apache-2.0
// Triangles without an image of every corner in one interval of a part: a focus lies between their corners,
// the mirror hides one, or the part ends there. Their images are bounded, and each pixel's ray told where
// within the bound they are seen.
//
// In:  a part's virtual vertices by interval (interval_search.h), in pixels too; its pixels' reflected rays.
// Steps:
//   1. A triangle with an image of some corners in an interval, but not of all, is drawn in none. Those that
//      turn their back to where they are reflected do not count.
//   2. It is seen about the images that its corners have in all intervals, for across a focus the images of
//      two intervals meet: in their box, widened by twice as far as the others would be to first order, no
//      farther than a flat mirror would show them.
//   3. There each pixel's ray is held against the triangle itself; it is added to what is confirmed where it
//      is nearer (part_pixels.h).
// Known failures: a triangle without the image of any corner is not known of; the box is a guess, not a
// bound. Cost: a pass over the triangles, and 10 ns for each pixel of the boxes.
// Source: methods.md, section 1, "Hints for the exact solver"; Hou 2006 and Liu 2011.
#pragma once

#include "catoptric/raster/tessellation.h"
#include "catoptric/virtual_object/mixed/interval_search.h"
#include "catoptric/virtual_object/mixed/part_pixels.h"

namespace catoptric::virtual_object {

struct PartImages {
  std::array<bool, kIntervals> isFound{};  ///< which intervals there are
  const std::array<IntervalVertices, kIntervals>& vertices;
  const std::array<std::vector<vec3>, kIntervals>& screens;  ///< projectVertices() of them
  const ReflectorMesh& mesh;                                 ///< the part's
  dmat4 clipFromDraw{1.0};
  dvec3 eye{0};  ///< draw space
  int widthPx = 0, heightPx = 0;
  double pixelsPerTangent = 0;
  gl::Scissor bounds;      ///< of the part's pixels
  std::uint32_t part = 0;  ///< its number
};

void drawIncomplete(const raster::TessellatedObjects& objects, const scene::WorldGeometry& world,
                    const RayImages& rays, const PartImages& images, MirrorPixels& pixels);

}  // namespace catoptric::virtual_object
