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
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/virtual_object/exact/mirror_tiles.h"
#include "catoptric/virtual_object/exact/ray_shaft.h"

namespace catoptric::virtual_object {

using geometry::HierarchyTriangle;
using geometry::TriangleHierarchy;

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
    TileRays rays;
    std::array<std::vector<Candidate>, kLevels> candidates;
    std::vector<std::uint32_t> parts;
    Cover cover;
  };
  struct Job {
    const RayImages& rays;
    const CoverQuery& query;
  };

  void coverTile(const Job& job, const MirrorTile& tile, std::size_t level,
                 const std::vector<Candidate>* from, Root& root) const;
  void findCandidates(const Job& job, const RayShaft& shaft, const std::vector<Candidate>* from,
                      std::vector<Candidate>& candidates) const;
  void emitTile(const Job& job, const MirrorTile& tile, const std::vector<Candidate>& candidates,
                Root& root) const;

  const TriangleHierarchy& hierarchy_;
  std::vector<Root> roots_;
};

}  // namespace catoptric::virtual_object
