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
#include "catoptric/virtual_object/formulas.h"
#include "catoptric/virtual_object/reflection_point.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

/// Ids in an explosion map: triangle * 2, + kExtensionBit if the pixel belongs to an extension polygon of it.
inline constexpr std::uint32_t kExtensionBit = 1;

/// Orthonormal frame of a map. For explosion maps z points from the centre to the eye, so that the singular
/// direction -z, the whole rim of the map's circle, lies in the hidden region.
struct MapFrame {
  dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

[[nodiscard]] MapFrame makeMapFrame(const dvec3& zDirection);

/// MapCoords with Blythe's factor: a unit direction (world) to the disc of radius 1. (The 1998 text misprints
/// the factor.) Pixels are (coords + 1) / 2 * resolution.
[[nodiscard]] inline dvec2 computeMapCoords(const MapFrame& frame, const dvec3& unitDirection) {
  return formulas::mapCoordsOf(frame.x, frame.y, frame.z, unitDirection);
}

/// (u, v) in a reflector triangle as a linear function of map coordinates: the paper's barycentrics, negative
/// ones included.
struct UvFromCoords {
  float u0, ux, uy, v0, vx, vy;
};

struct ExplosionMap {
  dvec3 centre{0};
  double radius = 0;  ///< of the sphere on which reflected rays are caught
  MapFrame frame;
  core::Image<std::uint32_t> ids;          ///< core::kNoId outside the circle; the circle touches the edges
  std::vector<dvec2> coords;               ///< map coordinates of every welded vertex of the mesh
  std::vector<UvFromCoords> uvFromCoords;  ///< of every triangle
  dvec2 extensionCentre{0, 0};             ///< extension polygons lead away from here
  std::size_t patchedPixels = 0;           ///< pixels that neither triangles nor extension polygons reached

  /// Pixel of map coordinates, clamped to the image.
  [[nodiscard]] std::uint32_t idAt(const dvec2& mapCoords) const {
    const int n = ids.width();
    return ids.at(formulas::mapPixelOf(mapCoords.x, n), formulas::mapPixelOf(mapCoords.y, n));
  }
};

/// Item buffer: what of the reflector (skirt included) the eye sees. Map coordinates of directions *from the
/// eye*, z axis towards the reflector, zoomed to the reflector.
struct HiddenMap {
  dvec3 eye{0};
  MapFrame frame;
  double nearest = 0;        ///< along frame.z, of everything seen
  double squaredCosine = 0;  ///< of the half angle of a cone around frame.z that holds everything seen
  dvec2 lower{-1, -1}, pixelsPerUnit{1, 1};  ///< pixel = (coords - lower) * pixelsPerUnit
  core::Image<std::uint32_t> ids;            ///< triangle index, core::kNoId where the reflector is not seen
  core::Image<float> distances;              ///< from the eye
};

/// What both maps say about a direction, ready for the refined solver: one fetch of 32 bytes.
struct SeedPixel {
  vec3 nearPosition{0};
  std::uint32_t nearTriangle = 0;
  vec3 farPosition{0};
  std::uint32_t farTriangle = 0;
};

struct SeedMap {
  core::Image<SeedPixel> pixels;

  [[nodiscard]] const SeedPixel& at(const dvec2& mapCoords) const {
    const int n = pixels.width();
    return pixels.at(formulas::mapPixelOf(mapCoords.x, n), formulas::mapPixelOf(mapCoords.y, n));
  }
};

/// The reflected rays of a mesh for one eye, the same for all maps.
struct ReflectedRays {
  std::vector<std::uint8_t> isFront;   ///< of every welded vertex
  std::vector<dvec3> directions;       ///< of every welded vertex, back-facing normals fixed up
  std::vector<std::uint8_t> isMapped;  ///< of every triangle: has a front-facing corner
};

/// Scratch memory of a map, kept from eye to eye.
struct MapScratch {
  std::vector<dvec2> coords;
  std::vector<float> distances;
  std::vector<std::uint32_t> queue;
};

/// 1998, fig. 6 steps 3 and 7. Returns the number of ordinary triangles with a front-facing corner.
std::size_t computeReflectedRays(const ReflectorMesh& mesh, const dvec3& eye, ReflectedRays& rays);

/// Fig. 6 steps 3 to 6. The map's images keep their size.
void fillExplosionMap(const ReflectorMesh& mesh, const dvec3& eye, double radius, const ReflectedRays& rays,
                      MapScratch& scratch, ExplosionMap& map);
void fillHiddenMap(const ReflectorMesh& mesh, const dvec3& eye, MapScratch& scratch, HiddenMap& map);
void fillSeedMap(const ReflectorMesh& mesh, const ExplosionMap& nearMap, const ExplosionMap& farMap,
                 SeedMap& map);

/// What a map says about a direction. `isExtension`: an extension polygon, or the skirt. (u, v) may lie
/// outside of the triangle (the papers' negative barycentrics).
struct MapAnswer {
  SurfacePoint at;
  bool isExtension = true;
};
[[nodiscard]] MapAnswer lookUpMap(const ReflectorMesh& mesh, const ExplosionMap& map, const dvec2& mapCoords);

[[nodiscard]] SurfacePoint clampToTriangle(std::uint32_t triangle, double u, double v);

}  // namespace catoptric::virtual_object
