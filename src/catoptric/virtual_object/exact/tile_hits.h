// SPDX-License-Identifier: Apache-2.0
// Which triangle each pixel of a mirror sees: steps 2 and 3 of solver `exact` where GL is software, by the
// processor.
//
// In:  as of TileCover.
// Out: an image of hits, which HitShading shades like one that GL has drawn; and rectangles of what a texture
//      may cut out or make transparent, which GL still draws, against the depths of that image.
// Steps:
//   1. The picture is cut into tiles of 8 x 8; where a tile's rays spread far, or too far for a shaft
//      (ray_shaft.h), it is cut into four.
//   2. The hierarchy's boxes that the shaft may meet are opened, the nearer one first, until all rays of the
//      tile have hit something before the rest.
//   3. The triangles of its leaves are tested, eight rays at a time (ray_tests.h).
// Departures: TileCover lists all triangles that a tile may see, because GL takes them in any order; here
//   those behind what was hit are never looked at. In software a rectangle costs GL a microsecond before its
//   first pixel, and a fine mesh has many in every tile.
// Cost: 0.2 to 0.7 us a pixel and core on the built-in scenes, more on finer meshes; nothing is allocated
// once the vectors have grown. Source: our own; bundles of rays against a hierarchy after Wald et al. 2001.
#pragma once

#include <cstdint>
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/virtual_object/exact/mirror_tiles.h"
#include "catoptric/virtual_object/exact/ray_shaft.h"
#include "catoptric/virtual_object/exact/ray_tests.h"

namespace catoptric::virtual_object {

/// What the rays of a mirror's pixels meet first, row by row from the lower left corner of the query's
/// bounds.
struct HitImage {
  std::vector<uvec2> hits;    ///< triangle + 1, bits of the distance; 0 = nothing
  std::vector<float> depths;  ///< 1 = nothing
};

class TileHits {
 public:
  explicit TileHits(const geometry::TriangleHierarchy& hierarchy) : hierarchy_(hierarchy) {}
  /// `cover.opaque` stays empty, and `cover.offeredPixels` counts tests. `depthFromDistance`: of a hit, as in
  /// exact_hit.frag. Opaque triangles that rays meet at distances up to RayImages' `directions.w` are missed.
  void compute(const RayImages& rays, const CoverQuery& query, float depthFromDistance, Cover& cover,
               HitImage& image);

 private:
  /// A triangle that only GL can judge, and the height above the shaft's foot where it may be met first.
  struct Doubtful {
    std::uint32_t index;  ///< into the hierarchy's triangles
    float nearest;
  };
  /// What one block of the picture needs.
  struct Block {
    TileRays rays;
    RayLanes lanes;
    std::vector<RayLanes::Test> tests;
    std::vector<Doubtful> doubtful;
    std::vector<std::uint32_t> parts;
    Cover cover;
  };
  struct Job {
    const RayImages& rays;
    const CoverQuery& query;
    float depthFromDistance;
    HitImage& image;
  };

  void findHits(const Job& job, const MirrorTile& tile, Block& block) const;
  void openBoxes(const Job& job, const RayShaft& shaft, Block& block) const;
  float testLeaf(const Job& job, const RayShaft& shaft, const geometry::TriangleHierarchy::Node& leaf,
                 Block& block) const;
  void writeHits(const Job& job, Block& block) const;
  void emitDoubtful(const Job& job, const MirrorTile& tile, Block& block) const;

  const geometry::TriangleHierarchy& hierarchy_;
  std::vector<Block> blocks_;
};

}  // namespace catoptric::virtual_object
