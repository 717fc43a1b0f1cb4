// SPDX-License-Identifier: Apache-2.0
// What drawing the reflections of one curved mirror is expected to take, by each way that `auto` may pick.
//
// In:  what there is to do, counted before anything is drawn.
// Out: milliseconds of a frame in which nothing has moved, on two cores of an AMD EPYC with a software OpenGL
//      (llvmpipe), which is what the constants were fitted to; of use to compare ways, not to predict another
//      machine, still less a GPU.
// Source: `scripts/method_expectations.py CATOPTRIC` prints what is expected beside what is measured, and the
//      constants that a fit of this run would give. Those here were fitted by hand, at 960x720, before the
//      processor drew the numbers of virtual triangles: refined may be cheaper now than they say.
#pragma once

#include <cstddef>
#include <span>

#include "catoptric/virtual_object/mixed/mirror_samples.h"

namespace catoptric::renderer {

/// Of one mirror in one view.
struct MirrorLoad {
  double pixels = 0;        ///< that show it
  double offered = 0;       ///< triangles that these pixels show, were nothing hidden
  double triangles = 0;     ///< that the tessellation of what it may reflect would make
  double virtualShare = 0;  ///< in parts: of the pixels, those that virtual objects would show
  double partsMs = 0;       ///< in parts: of those virtual objects (virtual_object::expectCosts())
};

/// Pixels and what is offered to them, from samples of the mirror.
[[nodiscard]] MirrorLoad measureLoad(const virtual_object::ReflectorMesh& mesh,
                                     const virtual_object::SceneRays& scene,
                                     const scene::WorldGeometry& world, const dvec3& eye,
                                     std::span<const virtual_object::MirrorSample> samples);

[[nodiscard]] double expectMapMs(const MirrorLoad& load);
[[nodiscard]] double expectRefinedMs(const MirrorLoad& load);  ///< one virtual object, convex mirrors
[[nodiscard]] double expectPartsMs(
    const MirrorLoad& load);  ///< a virtual object for each part that is worth it
[[nodiscard]] double expectExactMs(const MirrorLoad& load);

}  // namespace catoptric::renderer
