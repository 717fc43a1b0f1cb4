// SPDX-License-Identifier: Apache-2.0
// Which rays pass through points of which nothing is known yet?
//
// In: one trace at one location, scene points (world). Out: as of findRays().
//   1. The leaf of the octree in which a point lies gives rays that pass near; the search begins at the
//      nearest of them.
//   2. A ray at the very rim may be the nearest and yet lead nowhere: directions turn fast there. What is not
//      found is searched again from the ray of the leaf that is nearest to the middle of the map.
//
// Source: Martin & Popescu 2004, section 6.
#include "catoptric/reflection_morphing/octree_searches.h"

#include <algorithm>
#include <bit>

namespace catoptric::reflection_morphing {
namespace {

using Leaf = std::span<const std::uint32_t>;

const OctreeRay& findInnermostRay(const RayTable& table, const RayOctree& octree, Leaf leaf) {
  const float middle = 0.5f * float(table.size);
  const auto distance = [&](std::uint32_t ray) {
    const float x = octree.rays[ray].x - middle, y = octree.rays[ray].y - middle;
    return x * x + y * y;
  };
  return octree.rays[*std::min_element(
      leaf.begin(), leaf.end(), [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); })];
}

void setPlace(RayBatch& batch, std::size_t i, const OctreeRay& ray) {
  batch.x[i] = ray.x;
  batch.y[i] = ray.y;
}

vec3 pointOf(const RayBatch& batch, std::size_t i) {
  return {batch.point[0][i], batch.point[1][i], batch.point[2][i]};
}

}  // namespace

SearchSet searchFromOctree(const SampledTrace& trace, SearchSet which, OctreeSearch search, RayBatch& batch) {
  if (which == 0) return 0;
  std::array<Leaf, kMostSearches> leaves;
  // 1
  forEachSearch(which, [&](std::size_t i) {
    leaves[i] = trace.octree.findLeaf(pointOf(batch, i));
    __builtin_prefetch(leaves[i].data());
  });
  forEachSearch(which, [&](std::size_t i) {
    setPlace(batch, i, findNearestRay(trace.octree, leaves[i], pointOf(batch, i)));
  });
  const SearchSet inside = findRays(trace.table, which, kMostShortened, batch);
  if (search == OctreeSearch::FromNearest) return inside;
  // 2
  SearchSet again = 0;
  forEachSearch(which & ~inside, [&](std::size_t i) {
    if (leaves[i].size() > 1) again |= SearchSet(1) << i;
  });
  if (again == 0) return inside;
  RayBatch other = batch;
  forEachSearch(again, [&](std::size_t i) {
    setPlace(other, i, findInnermostRay(trace.table, trace.octree, leaves[i]));
  });
  const SearchSet found = findRays(trace.table, again, kMostShortened, other);
  forEachSearch(found, [&](std::size_t i) {
    batch.x[i] = other.x[i], batch.y[i] = other.y[i], batch.rest[i] = other.rest[i];
    for (int axis = 0; axis < 3; ++axis) batch.mirror[axis][i] = other.mirror[axis][i];
  });
  return inside | found;
}

}  // namespace catoptric::reflection_morphing
