// SPDX-License-Identifier: Apache-2.0
// Which of eight scene points does the mirror surely hide from the eye, and where are they drawn?
//
//   1. Beside the cone around the mirror, or in front of it: not hidden.
//   2. The triangle that the hidden map names, if all pixels around name one as well.
//   3. Where the ray to the point meets that triangle's plane, moved into the triangle: if that comes before
//      the point, the point is mirrored there (formulas::mirrorHiddenPoint(), README "Points without a
//      reflection").
//
// What VirtualObjectSolver::findHidingPoint() says of one point surely, in float.
#include <cmath>

#include "catoptric/virtual_object/lane_map.h"

namespace catoptric::virtual_object {
namespace {

using core::toBits;

/// Steps 1 and 2: their triangles, -1 for those that nothing hides.
CATOPTRIC_INLINE EightInts findHidingTriangles(const LaneView& view, const LaneVector& local,
                                               const LaneVector& toPoint) {
  const Eight along = dot(toPoint, broadcast(view.hiddenMap.z)), squared = dot(toPoint, toPoint);
  const EightInts isBehind =
      (along > view.hiddenNearest) & (along * along >= view.hiddenSquaredCosine * squared);
  EightInts triangles = EightInts{} - 1;
  if (toBits(isBehind) == 0) return triangles;
  const MapPlace place = findPlace(view.hiddenMap, local);
  for (int i = 0; i < kLanes; ++i) triangles[i] = view.surelyHiding[std::uint32_t(place.index[i])];
  return isBehind & place.isInside ? triangles : EightInts{} - 1;
}

struct HideLanes {
  CATOPTRIC_INLINE static void run(const LaneView& view, LaneGroup& group) {
    const LaneVector local = toLocal(view, loadVector(group.point)), eye = broadcast(view.eye);
    const LaneVector toPoint = local - eye;
    const EightInts triangles = findHidingTriangles(view, local, toPoint);
    EightInts hidden = triangles >= 0;
    group.hidden = 0;
    if (toBits(hidden) == 0) return;
    Triangles t;
    gather(view.triangles, hidden ? triangles : EightInts{}, t);
    const PlaneMeeting met = meetPlane(t, eye, toPoint);
    hidden &= (met.fraction > 0.0f) & (met.fraction < 1.0f);
    const Eight zero{}, one = zero + 1.0f;
    const Eight u = larger(met.u, zero), v = larger(met.v, zero);
    const Eight inside = 1.0f / larger(u + v, one);
    const LaneVector entry = t.position0 + (u * inside) * t.edge1 + (v * inside) * t.edge2;
    const LaneVector n = t.normal0 + (u * inside) * t.normal1 + (v * inside) * t.normal2;
    const LaneVector behind = local - entry, toEye = eye - entry;
    const LaneVector mirrored = behind - (2.0f * dot(behind, n) / dot(n, n)) * n;
    const Eight depth = squareRoot(dot(behind, behind)), longest = 0.5f * squareRoot(dot(toEye, toEye));
    const LaneVector place = entry + (depth > longest ? longest / depth : one) * mirrored;
    const LaneVector rest = broadcast(view.centreRest), centre = broadcast(view.centre);
    storeVector(group.position, (entry + rest) + centre);
    storeVector(group.virtualPosition, (place + rest) + centre);
    group.hidden = toBits(hidden) & group.wanted;
  }
};

}  // namespace

void findSurelyHiding(const core::Image<std::uint32_t>& ids, std::vector<std::int32_t>& surelyHiding) {
  const int width = ids.width(), height = ids.height();
  surelyHiding.assign(std::size_t(width) * std::size_t(height), -1);
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      bool isFilled = true;
      for (int k = 0; k < 9; ++k) isFilled = isFilled && ids.at(x + k % 3 - 1, y + k / 3 - 1) != core::kNoId;
      if (isFilled)
        surelyHiding[std::size_t(y) * std::size_t(width) + std::size_t(x)] = std::int32_t(ids.at(x, y));
    }
}

void hideLanes(const LaneView& view, LaneGroup& group) {
  core::runOnWidestVectors<HideLanes>(view, group);
}

}  // namespace catoptric::virtual_object
