// SPDX-License-Identifier: Apache-2.0
// One step of find_ray.h for eight searches at once, each in a lane of its own, in the widest vectors that
// the processor has.
#pragma once

#include "catoptric/reflection_morphing/ray_map.h"

namespace catoptric::reflection_morphing {

inline constexpr int kRayLanes = 8;

/// Structure of arrays: element i of each array belongs to search i. All of one map.
struct alignas(32) RayLanes {
  using Floats = float[kRayLanes];
  // In. Every lane must hold a cell, also those that are of no interest.
  const RayTexel* cell[kRayLanes];  ///< texel at the cell's lower corner
  Floats x, y;                      ///< where in the map each search stands, texels
  Floats u, v;                      ///< ... and in its cell, 0 to 1
  Floats point[3];                  ///< the scene point, world
  // Out.
  Floats stepX, stepY;  ///< texels; at most a quarter of the map
  Floats along;         ///< > 0: the point lies the way the ray goes
  Floats mirror[3];     ///< first mirror point after the step, world
  Floats rest;          ///< from there to the scene point
};

/// Evaluates all lanes.
void evaluateRayLanes(const RayMap& map, RayLanes& lanes);

}  // namespace catoptric::reflection_morphing
