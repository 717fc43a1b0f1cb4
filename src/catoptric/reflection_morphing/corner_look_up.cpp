// SPDX-License-Identifier: Apache-2.0
// Steps:
//   1. Vertices outside of the shafts (ray_shaft.h) of both the first and the last location that has the
//      trace are left alone.
//   2. The octree of the first location is asked for the others, 64 at a time. What it does not see the last
//      location is asked for; what that does not see either is left alone.
//   3. The other locations start from what the first or the last one has found (corner_batch.cpp).
#include "catoptric/reflection_morphing/corner_look_up.h"

#include <algorithm>

#include "catoptric/reflection_morphing/octree_searches.h"

namespace catoptric::reflection_morphing {
namespace {

std::size_t findFirst(const CellTrace& trace) {
  return std::size_t(std::find_if(trace.begin(), trace.end(), [](auto* t) { return t; }) - trace.begin());
}

std::size_t findLast(const CellTrace& trace) {
  return std::size_t(std::find_if(trace.rbegin(), trace.rend(), [](auto* t) { return t; }).base() -
                     trace.begin()) -
         1;
}

}  // namespace

CornerLookUp::CornerLookUp(const CellTrace& trace, std::span<const vec3> points, bool all,
                           CornerPoints& corners)
    : trace_(trace),
      points_(points),
      all_(all),
      seenFromFirst_(trace, findFirst(trace), corners),
      seenFromLast_(trace, findLast(trace), corners) {
  first_.location = findFirst(trace);
  last_.location = findLast(trace);
}

/// True when it is full.
bool CornerLookUp::Question::add(std::uint32_t vertex, const vec3& point) {
  vertices[count] = vertex;
  for (int axis = 0; axis < 3; ++axis) batch.point[axis][count] = point[axis];
  return ++count == kMostSearches;
}

void CornerLookUp::add(std::uint32_t vertex) {
  const vec3& point = points_[vertex];
  // 1
  if (!all_ && !trace_[first_.location]->shaft.mayReach(point) &&
      !trace_[last_.location]->shaft.mayReach(point))
    return;
  if (first_.add(vertex, point)) askFirst();
}

void CornerLookUp::run() {
  askFirst();
  askLast();
  seenFromFirst_.run();
  seenFromLast_.run();
}

/// Step 2.
void CornerLookUp::askFirst() {
  const SearchSet seen = searchFromOctree(*trace_[first_.location], firstSearches(first_.count),
                                          OctreeSearch::FromNearestAndInnermost, first_.batch);
  for (std::size_t i = 0; i < first_.count; ++i) {
    const bool isSeen = (seen >> i & 1) != 0;
    if (isSeen || all_)
      seenFromFirst_.take(first_.vertices[i], first_.batch, i, isSeen);
    else if (last_.location != first_.location && last_.add(first_.vertices[i], points_[first_.vertices[i]]))
      askLast();
  }
  first_.count = 0;
}

void CornerLookUp::askLast() {
  const SearchSet seen = searchFromOctree(*trace_[last_.location], firstSearches(last_.count),
                                          OctreeSearch::FromNearestAndInnermost, last_.batch);
  forEachSearch(seen, [&](std::size_t i) { seenFromLast_.take(last_.vertices[i], last_.batch, i, true); });
  last_.count = 0;
}

}  // namespace catoptric::reflection_morphing
