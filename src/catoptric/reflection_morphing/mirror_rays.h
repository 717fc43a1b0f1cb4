// SPDX-License-Identifier: Apache-2.0
// Rays against the mirrors only: diffuse objects are left out, so that they may move (2004, section 4.1).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::reflection_morphing {

/// Reflectors hit by a ray, in order, as indices into WorldGeometry::reflectors.
using Trace = std::vector<std::uint32_t>;

/// A view ray after its last mirror.
struct ReflectedRay {
  Trace trace;
  double distance = 0;  ///< from the location to the first mirror point
  double between = 0;   ///< from the first mirror point to the last
  dvec3 origin{0};      ///< the last mirror point
  dvec3 direction{0};   ///< unit, the way it leaves
};

class MirrorRays {
 public:
  /// `world` must outlive the object. `withObstacles`: findObstacle() will be called.
  explicit MirrorRays(const scene::WorldGeometry& world, bool withObstacles = false);

  /// Follows a ray (unit direction) over at most `bounces` mirrors. Calls visit(ray) after each mirror.
  template <class Visit>
  void follow(const dvec3& from, const dvec3& direction, int bounces, const Visit& visit) const {
    ReflectedRay ray;
    ray.origin = from;
    ray.direction = direction;
    std::uint32_t triangle = core::kNoId;
    for (int bounce = 0; bounce < bounces; ++bounce) {
      if (!reflect(ray, triangle)) return;
      visit(ray);
    }
  }

  /// How far the ray goes before it meets a surface that is no reflector; infinity.
  [[nodiscard]] double findObstacle(const ReflectedRay& ray) const;

  [[nodiscard]] const scene::WorldGeometry& world() const { return world_; }

 private:
  /// The next mirror of the ray; false where there is none.
  bool reflect(ReflectedRay& ray, std::uint32_t& triangle) const;

  const scene::WorldGeometry& world_;
  double least_ = 0;  ///< shortest segment between two mirrors
  geometry::TriangleHierarchy hierarchy_, obstacles_;
};

}  // namespace catoptric::reflection_morphing
