// SPDX-License-Identifier: Apache-2.0
// Batches of searches: each is what it is alone.
#include <gtest/gtest.h>

#include "catoptric/reflection_morphing/octree_searches.h"
#include "mirror_world.h"

namespace catoptric::reflection_morphing {
namespace {

using namespace test;

const dvec3 kEye(0.4, 0.3, 2.1);

struct Fixture {
  scene::WorldGeometry world = makeSphereWorld();
  MirrorRays rays{world};
  std::shared_ptr<const SamplingLocation> location = makeLocation(rays, kEye, makeOptions(world, 128));
  const SampledTrace& trace = location->traces.at(0);

  /// Known points in front of the mirror, every fourth of them moved into its shadow; started at the octree's
  /// rays.
  [[nodiscard]] RayBatch makeBatch() const {
    RayBatch batch;
    const auto known = makeKnownPoints(rays, kEye, {0}, kMostSearches, 17);
    for (std::size_t i = 0; i < kMostSearches; ++i) {
      const vec3 q =
          i % 4 == 3 ? vec3(-1.5 * glm::normalize(kEye) + 0.01 * double(i)) : vec3(known.at(i).scenePoint);
      const OctreeRay& ray = findNearestRay(trace.octree, trace.octree.findLeaf(q), q);
      for (int axis = 0; axis < 3; ++axis) batch.point[axis][i] = q[axis];
      batch.x[i] = ray.x, batch.y[i] = ray.y;
    }
    return batch;
  }
};

TEST(FindRays, eachSearchOfABatchIsWhatItIsAlone) {
  const Fixture f;
  const RayBatch start = f.makeBatch();
  RayBatch together = start, few = start;
  const SearchSet some = 0x8000100020004003;  // so few that they are closed up from the first step on
  const SearchSet inside = findRays(f.trace.table, ~SearchSet(0), kMostShortened, together);
  EXPECT_GT(std::popcount(inside), 40);
  EXPECT_LT(std::popcount(inside), 56);
  EXPECT_EQ(findRays(f.trace.table, some, kMostShortened, few), inside & some);
  for (std::size_t i = 0; i < kMostSearches; ++i) {
    const vec3 q(start.point[0][i], start.point[1][i], start.point[2][i]);
    const FoundRay alone = findRay(f.trace.table, q, {start.x[i], start.y[i]});
    EXPECT_EQ(alone.isInside, (inside >> i & 1) != 0);
    EXPECT_EQ(alone.mirrorPoint, vec3(together.mirror[0][i], together.mirror[1][i], together.mirror[2][i]));
    EXPECT_EQ(alone.rest, together.rest[i]);
    const bool isWanted = (some >> i & 1) != 0;  // what is not asked for keeps what it has
    EXPECT_EQ(few.x[i], isWanted ? together.x[i] : start.x[i]);
    EXPECT_EQ(few.rest[i], isWanted ? together.rest[i] : start.rest[i]);
  }
}

TEST(FindRays, whatDoesNotGoOnFromTheEdgeIsNotFoundElsewhere) {
  const Fixture f;
  RayBatch goesOn = f.makeBatch(), ends = goesOn;
  const SearchSet found = findRays(f.trace.table, ~SearchSet(0), kMostShortened, goesOn);
  const SearchSet sooner = findRays(f.trace.table, ~SearchSet(0), 0, ends);
  EXPECT_EQ(sooner & ~found, 0u);
  forEachSearch(sooner, [&](std::size_t i) { EXPECT_EQ(ends.mirror[0][i], goesOn.mirror[0][i]); });
}

TEST(FindRays, findsOutWhereTheTableIsFilled) {
  const Fixture f;
  RayBatch batch;
  for (std::size_t i = 0; i < kMostSearches; ++i) {
    batch.x[i] = 2.3f * float(i) - 4;
    batch.y[i] = 61 + 0.2f * float(i);
  }
  const SearchSet filled = findFilled(f.trace.table, ~SearchSet(0), batch);
  for (std::size_t i = 0; i < kMostSearches; ++i)
    EXPECT_EQ((filled >> i & 1) != 0, f.trace.table.isFilled({batch.x[i], batch.y[i]}));
  EXPECT_NE(filled, 0u);
  EXPECT_NE(filled, ~SearchSet(0));
  EXPECT_EQ(findFilled(f.trace.table, 0xff00u, batch), filled & 0xff00u);
}

}  // namespace
}  // namespace catoptric::reflection_morphing
