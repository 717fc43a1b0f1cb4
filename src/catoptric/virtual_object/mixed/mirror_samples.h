// SPDX-License-Identifier: Apache-2.0
// Points of a curved mirror that stand for its pixels, before anything is drawn: what is expected of a way of
// drawing it is asked there (renderer/expected_error.h).
//
// In:  a mirror's mesh, the scene's triangles, a camera (world, pixels).
// Out: points of the mirror that the camera sees, and how many pixels each stands for.
// Steps:
//   1. Positions spread evenly over the mesh's triangles: several in each where there are few, one in every
//      so many where there are many. The same ones for every eye, so that a figure made of them changes
//      little where the eye moves little.
//   2. Those that turn their back, lie outside the picture or have something before them are left out.
//   3. A position stands for the area on the screen of its share of the triangle.
// Known failures: a mesh whose triangles differ much in size is sampled unevenly, if rightly weighted.
// Cost: a ray a position, about 1 us.
#pragma once

#include <vector>

#include "catoptric/virtual_object/mixed/view_forecast.h"
#include "catoptric/virtual_object/reflection_point.h"

namespace catoptric::virtual_object {

struct MirrorSample {
  SurfacePoint at;
  double pixels = 0;      ///< that it stands for
  double cellPixels = 0;  ///< of the parallelogram of its triangle's edges on the screen
};

/// `about`: how many positions are tried, give or take a factor of two where there are many triangles.
[[nodiscard]] std::vector<MirrorSample> sampleMirror(const ReflectorMesh& mesh, const SceneRays& scene,
                                                     const scene::CameraFrame& camera, std::size_t about);

/// Does the eye see the back of a double-sided mirror? Yes where back faces fill more than twice the solid
/// angle of front faces: of a closed surface both fill the same, and no front hides the back of an open one.
[[nodiscard]] bool isSeenFromBehind(const scene::WorldGeometry& world, std::uint32_t reflector,
                                    const dvec3& eye);

}  // namespace catoptric::virtual_object
