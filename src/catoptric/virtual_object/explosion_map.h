// SPDX-License-Identifier: Apache-2.0
// Explosion maps: 2-D maps of directions around a reflector to the reflector triangle that reflects that
// direction to the eye (Ofek & Rappoport 1998, section 4.1; Blythe 1999), and the hidden map, an item buffer
// seen from the eye. Ids are exact integers, filled by our own rasterizer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/core/math.h"
#include "catoptric/core/seen.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// Ids in a map: triangle * 2 + (1 if the pixel belongs to an extension polygon of that triangle).
inline constexpr std::uint32_t kExtensionBit = 1;

/// Orthonormal frame of a map; z points from the centre to the eye, so that the singular direction -z, the
/// whole rim of the map's circle, lies in the hidden region.
struct MapFrame {
  dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

[[nodiscard]] MapFrame makeMapFrame(const dvec3& towardsEye);

/// MapCoords with Blythe's factor: a direction (unit, world) to [-1, 1]^2, inside the unit circle. The 1998
/// text misprints the factor.
[[nodiscard]] inline dvec2 computeMapCoords(const MapFrame& frame, const dvec3& unitDirection) {
  const double z = glm::dot(frame.z, unitDirection);
  const double scale = 1.0 / std::sqrt(std::max(2.0 * (z + 1.0), 1e-12));
  return {glm::dot(frame.x, unitDirection) * scale, glm::dot(frame.y, unitDirection) * scale};
}

struct ExplosionMap {
  dvec3 centre{0};
  double radius = 0;  ///< of the sphere on which reflected rays are caught
  MapFrame frame;
  core::Image<std::uint32_t> ids;  ///< core::kNoId outside the circle; the circle touches the image's edges
  std::vector<dvec2> coords;       ///< map coordinates in [-1, 1]^2 of every welded vertex of the mesh
};

/// Item buffer: what of the reflector (skirt included) the eye sees. Map coordinates of directions *from the
/// eye*, z axis towards the reflector, zoomed to the reflector.
struct HiddenMap {
  dvec3 eye{0};
  MapFrame frame;
  dvec2 lower{-1, -1}, scale{1, 1};  ///< pixel = (coords - lower) * scale
  core::Image<std::uint32_t> ids;    ///< triangle index, core::kNoId where the reflector is not seen
  core::Image<float> distances;      ///< from the eye
};

/// Scratch memory, kept from eye to eye.
struct MapScratch {
  std::vector<std::uint8_t> facing;
  std::vector<dvec3> fixedNormals;
  std::vector<dvec2> coords;
  std::vector<double> distances;
  std::vector<std::uint32_t> queue;
};

void fillExplosionMap(const ReflectorMesh& mesh, const dvec3& eye, double radius, int resolution,
                      ExplosionMap& map, MapScratch& scratch);
void fillHiddenMap(const ReflectorMesh& mesh, const dvec3& eye, int resolution, HiddenMap& map,
                   MapScratch& scratch);

}  // namespace catoptric::virtual_object
