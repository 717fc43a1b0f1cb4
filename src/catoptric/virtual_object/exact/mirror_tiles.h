// SPDX-License-Identifier: Apache-2.0
// Tiles of a mirror's pixels and what is found for them: shared by the two ways of solver `exact`, for GL
// (tile_cover.h) and on the processor (tile_hits.h).
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/core/seen.h"
#include "catoptric/virtual_object/hit_shading.h"

namespace catoptric::virtual_object {

/// Rays of a picture's mirror pixels, bottom row first as on the GPU. `words`: ids of
/// raster/level_pixels.glsl.
struct RayImages {
  int widthPx = 0, heightPx = 0;
  std::vector<vec4> origins, directions;
  std::vector<uvec2> words;
};

struct CoverQuery {
  int x = 0, y = 0, width = 0, height = 0;  ///< bounds of the mirror's pixels
  std::uint32_t word = 0;                   ///< which pixels in them
  std::uint32_t excludedPart = core::kNoId;
  std::uint32_t ownPart = core::kNoId;  ///< never hides anything: rays may start on its triangles
  double reach = 0;                     ///< no point of the scene is farther from a mirror pixel
};

struct Cover {
  std::vector<CoverRect> opaque, masked, blended;  ///< item: triangle
  std::vector<CoverRect> parts;     ///< item: part of opaque and masked ones; disjoint for each part
  std::uint64_t offeredPixels = 0;  ///< pixels of opaque and masked, counted once for each triangle

  void clear();
  void append(const Cover& other);
};

/// Pixels [x, x + edge) x [y, y + edge).
struct MirrorTile {
  int x = 0, y = 0, edge = 0;
  /// What lies within the query's bounds, which it must touch.
  [[nodiscard]] CoverRect within(const CoverQuery& query) const;
  /// k = 0..3.
  [[nodiscard]] MirrorTile quarter(int k) const;
};

/// The rays of a tile's pixels that are of the mirror.
struct TileRays {
  std::vector<vec4> origins, directions;
  std::vector<std::uint32_t> pixels;  ///< row by row from the lower left corner of the query's bounds
  /// False where there are none.
  bool gather(const RayImages& rays, const CoverQuery& query, const MirrorTile& tile);
};

/// Adds a part that is not among them.
void notePart(std::uint32_t part, std::vector<std::uint32_t>& parts);

}  // namespace catoptric::virtual_object
