// SPDX-License-Identifier: Apache-2.0
// One step of find_ray.h for eight searches at once, each in a lane of its own, in the widest vectors that
// the processor has.
#pragma once

#include "catoptric/reflection_morphing/ray_table.h"

namespace catoptric::reflection_morphing {

inline constexpr int kRayLanes = 8;
inline constexpr float kLastStep = 0.1f;  ///< texels; what it leaves is some thousandths of a texel

/// Structure of arrays: element i of each array belongs to search i. All of one table.
struct alignas(32) RayLanes {
  using Floats = float[kRayLanes];
  using Ints = std::int32_t[kRayLanes];
  // In. Every lane must stand where the table is filled, also those that are of no interest.
  Floats x, y;      ///< where in the table each search stands, texels
  Floats point[3];  ///< the scene point, world
  // Out.
  Floats nextX, nextY;  ///< after the step; at most a quarter of the table away
  Ints isShort;         ///< not 0: the step is shorter than kLastStep
  Ints isAhead;         ///< not 0: the point lies the way the ray goes
  Ints nextCell;        ///< index of the cell after the step, -1 off the table
  Ints nextCorner;      ///< which corner of it is nearest, as in RayTable::cells
  Floats mirror[3];     ///< first mirror point after the step, world
  Floats rest;          ///< from there to the scene point
};

/// Evaluates all lanes.
void evaluateRayLanes(const RayTable& table, RayLanes& lanes);

}  // namespace catoptric::reflection_morphing
