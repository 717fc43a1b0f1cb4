// SPDX-License-Identifier: Apache-2.0
// Rays against the reflectors only: diffuse objects are left out, so that they may move (2004, section 4.1).
// Mirrors reflect them; solids of glass refract them, by the same index and up to as many crossings as in a
// frame (2004, section 9: refracted rays instead of reflected ones).
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

/// A view ray after its last reflector.
struct ReflectedRay {
  Trace trace;
  double distance = 0;  ///< from the location to the first mirror point
  double between = 0;   ///< from the first mirror point to the last
  dvec3 origin{0};      ///< the last mirror point
  dvec3 direction{0};   ///< unit, the way it leaves
  int mirrors = 0, crossings = 0;
  std::uint32_t medium = core::kNoId;  ///< the solid that it is in
  bool isTotal = false;                ///< it does not leave its last reflector, but stays inside
};

class MirrorRays {
 public:
  /// `world` must outlive the object. `withObstacles`: findObstacle() will be called.
  explicit MirrorRays(const scene::WorldGeometry& world, bool withObstacles = false);

  /// Follows a ray (unit direction) over at most `bounces` mirrors and scene::kMostCrossings surfaces of
  /// solids, `links` of both. Calls visit(ray) after each one behind which it is outside of solids, and
  /// where reflection inside a solid is total; there it ends.
  template <class Visit>
  void follow(const dvec3& from, const dvec3& direction, int bounces, std::size_t links,
              const Visit& visit) const {
    ReflectedRay ray;
    ray.origin = from;
    ray.direction = direction;
    std::uint32_t triangle = core::kNoId;
    while (ray.trace.size() < links && passOn(ray, triangle)) {
      if (ray.mirrors > bounces || ray.crossings > scene::kMostCrossings) return;
      if (ray.medium == core::kNoId || ray.isTotal) visit(ray);
      if (ray.isTotal) return;
    }
  }

  /// How far the ray goes before it meets a surface that is no reflector; infinity.
  [[nodiscard]] double findObstacle(const ReflectedRay& ray) const;

  [[nodiscard]] const scene::WorldGeometry& world() const { return world_; }

 private:
  /// Over the next reflector of the ray; false where there is none.
  bool passOn(ReflectedRay& ray, std::uint32_t& triangle) const;

  const scene::WorldGeometry& world_;
  double least_ = 0;  ///< shortest segment between two mirrors
  geometry::TriangleHierarchy hierarchy_, obstacles_;
};

}  // namespace catoptric::reflection_morphing
