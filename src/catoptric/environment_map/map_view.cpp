// SPDX-License-Identifier: Apache-2.0
#include "catoptric/environment_map/map_view.h"

#include <limits>

#include "catoptric/environment_map/environment_map_method.h"
#include "catoptric/geometry/nearest_hit.h"

namespace catoptric::environment_map {
namespace formulas {

using namespace glm;  // NOLINT: the included file is GLSL
using Real = double;
using Real3 = dvec3;

#define CATOPTRIC_FN inline
#include "lib/box_lookup.glsl"
#undef CATOPTRIC_FN

}  // namespace formulas

MapView::MapView(const scene::WorldGeometry& world, const geometry::TriangleHierarchy& triangles,
                 std::uint32_t reflector, bool boxCorrected)
    : triangles_(triangles),
      part_(world.reflectors[reflector].part),
      centre_(world.reflectors[reflector].centre),
      nearPlane_(1e-3 * world.reflectors[reflector].radius),  // of raster::SceneCubeCache
      box_(findRoomBox(world, centre_)),
      boxCorrected_(boxCorrected) {}

MapView::Shown MapView::look(const dvec3& origin, const dvec3& direction) const {
  const dvec3 d =
      boxCorrected_ ? formulas::lookUpInBox(box_.lower, box_.upper, centre_, origin, direction) : direction;
  const auto hit = geometry::findNearestHit(triangles_, centre_, d, nearPlane_, core::kNoId, part_);
  if (!hit) return {d, std::numeric_limits<double>::infinity(), core::kNoId};
  return {centre_ + hit->distance * d, hit->distance, hit->triangle};
}

}  // namespace catoptric::environment_map
