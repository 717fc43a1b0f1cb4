// SPDX-License-Identifier: Apache-2.0
// Which triangle may be seen in which pixels of a mirror: step 2 of solver `exact`.
//
// In:  the reflected ray of every mirror pixel (world), the pixels of one mirror, the hierarchy of the
// scene's
//      triangles.
// Out: rectangles of pixels, each with a triangle that may be seen there, conservatively: where a triangle is
//      missing, no ray of the rectangle meets it before something opaque.
// Steps:
//   1. The picture is cut into tiles; a tile's rays get a shaft (ray_shaft.h). Where they spread too far for
//      one, the tile is cut into four.
//   2. Its triangles are those of the hierarchy, or of the tile it was cut from, that the shaft may meet.
//   3. What lies behind a triangle that covers the whole tile is dropped.
//   4. A tile with few triangles, or a small one, becomes rectangles; any other is cut into four.
// Nothing here knows the shape of the mirror: convex, concave, saddle or a chain of several, its rays are all
// that counts. Cost: docs and figures in virtual_object/README.md. Tiles are shared out over all cores;
// nothing is allocated once the vectors have grown.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/core/seen.h"
#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/virtual_object/exact/ray_shaft.h"
#include "catoptric/virtual_object/hit_shading.h"

namespace catoptric::virtual_object {

using geometry::HierarchyTriangle;
using geometry::TriangleHierarchy;

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
};

class TileCover {
 public:
  explicit TileCover(const TriangleHierarchy& hierarchy) : hierarchy_(hierarchy) {}
  void compute(const RayImages& rays, const CoverQuery& query, Cover& cover);

 private:
  /// A candidate that the shaft may meet.
  struct Candidate {
    std::uint32_t index;  ///< into the hierarchy's triangles
    float nearest;
  };
  static constexpr int kLevels = 6;  ///< edges 32 to 1
  struct Root {
    std::vector<vec4> origins, directions;
    std::array<std::vector<Candidate>, kLevels> candidates;
    std::vector<std::uint32_t> parts;
    Cover cover;
  };
  struct Job {
    const RayImages& rays;
    const CoverQuery& query;
  };
  struct Tile {
    int x, y, level;
    [[nodiscard]] int edge() const { return 1 << (kLevels - 1 - level); }
  };

  void coverTile(const Job& job, const Tile& tile, const std::vector<Candidate>* from, Root& root) const;
  static bool gatherRays(const Job& job, const Tile& tile, Root& root);
  void findCandidates(const Job& job, const RayShaft& shaft, const std::vector<Candidate>* from,
                      std::vector<Candidate>& candidates) const;
  void emitTile(const Job& job, const Tile& tile, const std::vector<Candidate>& candidates, Root& root) const;

  const TriangleHierarchy& hierarchy_;
  std::vector<Root> roots_;
};

}  // namespace catoptric::virtual_object
