// SPDX-License-Identifier: Apache-2.0
#include "catoptric/renderer/near_plane.h"

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/mesh_measures.h"

namespace catoptric::renderer {

double chooseNearPlane(const scene::WorldGeometry& geometry, const scene::CameraFrame& camera) {
  const double sceneRadius = geometry.bounds.isEmpty() ? 1.0 : std::max(geometry.bounds.radius(), 1e-6);
  double nearest = sceneRadius;
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return dvec3(geometry.positions[geometry.indices[i + k]]); };
    const dvec3 a = corner(0), b = corner(1), c = corner(2), centre = (a + b + c) / 3.0;
    const double reach =
        std::sqrt(std::max({glm::dot(a - centre, a - centre), glm::dot(b - centre, b - centre),
                            glm::dot(c - centre, c - centre)}));
    if (glm::length(camera.eye - centre) - reach >= nearest) continue;  // its bounding sphere is too far away
    nearest = std::min(nearest, geometry::computeDistanceToTriangle(camera.eye, a, b, c));
  }
  // The corner of the picture is the farthest off axis: a point at distance d lies at least d cos beyond the
  // eye.
  const double aspect = double(camera.widthPx) / camera.heightPx;
  const double cosine =
      1.0 / std::sqrt(1.0 + camera.tanHalfFovY * camera.tanHalfFovY * (1.0 + aspect * aspect));
  return std::max(0.9 * cosine * nearest, 2e-4 * sceneRadius);
}

}  // namespace catoptric::renderer
