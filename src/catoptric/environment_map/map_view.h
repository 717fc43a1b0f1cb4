// SPDX-License-Identifier: Apache-2.0
// What an environment map shows for a ray of its mirror, before any map is drawn: so that its error can be
// expected (renderer/expected_error.h).
//
// In:  the scene's triangles; a mirror; a ray from its surface (world).
// Out: the point, or the direction of the sky, that the map holds in the direction in which it is looked up,
//      as environment_map.frag does.
// Departures: the map's texels, and cut-out textures, are not asked for.
// Cost: one ray, about 1 us.
#pragma once

#include <cstdint>
#include <span>

#include "catoptric/core/seen.h"
#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::environment_map {

class MapView {
 public:
  struct Shown {
    dvec3 point{0};                        ///< of the sky: the unit direction from the centre
    double distance = 0;                   ///< from the centre; infinite for the sky
    std::uint32_t triangle = core::kNoId;  ///< kNoId = sky
  };

  /// `triangles`: of all of `world` (scene::listTriangles()), which both must outlive the object.
  MapView(const scene::WorldGeometry& world, const geometry::TriangleHierarchy& triangles,
          std::uint32_t reflector, bool boxCorrected);

  /// For the ray from `origin` along the unit `direction`.
  [[nodiscard]] Shown look(const dvec3& origin, const dvec3& direction) const;

 private:
  const geometry::TriangleHierarchy& triangles_;
  std::uint32_t part_;  ///< the mirror's: the map is taken without it
  dvec3 centre_;
  double nearPlane_;
  core::Box box_;
  bool boxCorrected_;
};

}  // namespace catoptric::environment_map
