// SPDX-License-Identifier: Apache-2.0
// Steps: 1 the direction in which the nearest ray of the table leaves, 2 the direction in which the chart
// says that it comes, 3 the unit vector half way between.
#include "catoptric/reflection_morphing/mirror_normals.h"

#include <cassert>

#include "catoptric/core/eight_lanes.h"

namespace catoptric::reflection_morphing {
namespace {

using core::dot;
using core::Eight;
using core::EightInts;
using core::kLanes;
using core::larger;
using core::load;
using core::squareRoot;
using core::store;

/// Steps 1 and 2 in the table's frame: the difference of both directions.
CATOPTRIC_INLINE void computeTurns(const RayTable& table, const Eight& cx, const Eight& cy, Eight* turn) {
  const Eight end = Eight{} + float(table.size - 1);
  const auto nearest = [&](const Eight& place) __attribute__((always_inline)) {
    const Eight onTable = place > 0.0f ? (place < end ? place : end) : Eight{};
    return __builtin_convertvector(onTable + 0.5f, EightInts);
  };
  const EightInts at = nearest((cy - table.lower.y) / table.step.y) * table.size +
                       nearest((cx - table.lower.x) / table.step.x);
  float leaving[3][kLanes];
  for (int i = 0; i < kLanes; ++i)
    for (int k = 0; k < 3; ++k) leaving[k][i] = table.leaving[std::size_t(at[i])][k];
  const Eight k = 2.0f / (1.0f + cx * cx + cy * cy);
  turn[0] = load(leaving[0]) - k * cx;
  turn[1] = load(leaving[1]) - k * cy;
  turn[2] = load(leaving[2]) - (k - 1.0f);
}

struct AddNormals {
  CATOPTRIC_INLINE static void run(const RayTable& table, const RayBatch::Floats& chartX,
                                   const RayBatch::Floats& chartY, std::array<RayBatch::Floats, 3>& sum) {
    const vec3 &right = table.chart.right, &up = table.chart.up, &axis = table.chart.axis;
    for (std::size_t first = 0; first < kMostSearches; first += kLanes) {
      Eight turn[3];
      computeTurns(table, load(&chartX[first]), load(&chartY[first]), turn);
      const Eight perLength = 1.0f / squareRoot(larger(dot(turn, turn), Eight{} + 1e-20f));
      for (int k = 0; k < 3; ++k) {
        const Eight along = turn[0] * right[k] + turn[1] * up[k] + turn[2] * axis[k];
        store(&sum[std::size_t(k)][first], load(&sum[std::size_t(k)][first]) + along * perLength);
      }
    }
  }
};

}  // namespace

void addNormals(const RayTable& table, const RayBatch::Floats& chartX, const RayBatch::Floats& chartY,
                std::array<RayBatch::Floats, 3>& sum) {
  assert(table.origins.empty());
  core::runOnWidestVectors<AddNormals>(table, chartX, chartY, sum);
}

}  // namespace catoptric::reflection_morphing
