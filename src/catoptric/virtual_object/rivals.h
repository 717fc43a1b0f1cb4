// SPDX-License-Identifier: Apache-2.0
// Which of two triangles is seen at a mirror pixel, if their virtual images are about equally near there?
//
// In:  hits as NumberRaster found them, with a second triangle at some pixels; the pixels' rays.
// Out: at those pixels, the triangle that the ray meets first, with its distance.
// Where none is seen, but beside it: does the ray meet what is seen there?
// The ray is that of ray tracing: the second triangle is seen if the ray meets it, and before the plane of
// the first one. Whether it meets the first one itself is not asked, for near an edge it may meet its
// neighbour, and what lies behind both would show through. Why: virtual triangles are flat and the images
// that they stand for are not. They are cut until their edges are right to --max-error sideways; in depth a
// wall 4 m away may sag by 20 mm then, in a mirror of 140 px, and a skirting board 15 mm before it came out
// in holes.
#pragma once

#include "catoptric/virtual_object/lane_shading.h"
#include "catoptric/virtual_object/number_raster.h"

namespace catoptric::virtual_object {

/// `images`: of the level before, within the bounds that `numbers` is of. Parallel.
void settleRivals(const LaneImages& images, const SceneTriangles& triangles, NumberImage& numbers);

}  // namespace catoptric::virtual_object
