// SPDX-License-Identifier: Apache-2.0
// Which side of a double-sided mirror is seen.
#include "catoptric/virtual_object/mixed/mirror_samples.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/shapes.h"
#include "reflection_harness.h"

namespace catoptric::virtual_object {
namespace {

scene::WorldGeometry makeDoubleSided(const geometry::Mesh& mesh) {
  scene::WorldGeometry world = test::TestWorld(mesh).geometry();
  world.reflectors[0].doubleSided = true;
  return world;
}

TEST(SideSeen, OfAClosedMirrorIsTheFrontFromEverywhereOutside) {
  // A trim on a car's wing: flat and long, so that most of its corners may be turned away.
  const scene::WorldGeometry strip = makeDoubleSided(geometry::makeBox({0.2, 0.01, 4.0}));
  const scene::WorldGeometry ball = makeDoubleSided(geometry::makeIcosphere(1.0, 12));
  for (int i = 0; i < 200; ++i) {
    const double turn = 2.399963 * i, height = 1.0 - 2.0 * (i + 0.5) / 200,
                 across = std::sqrt(1 - height * height);
    const dvec3 from(across * std::cos(turn), height, across * std::sin(turn));
    EXPECT_FALSE(isSeenFromBehind(strip, 0, 3.0 * from)) << i;
    EXPECT_FALSE(isSeenFromBehind(ball, 0, 1.05 * from)) << i;
    EXPECT_TRUE(isSeenFromBehind(ball, 0, 0.9 * from)) << i;
  }
}

TEST(SideSeen, OfAnOpenMirrorIsTheOneThatTheEyeIsOn) {
  const scene::WorldGeometry disc = makeDoubleSided(geometry::makeDisc(1.0, 0.0, 32, true));
  EXPECT_FALSE(isSeenFromBehind(disc, 0, {0.3, 0.2, 2.0}));
  EXPECT_TRUE(isSeenFromBehind(disc, 0, {0.3, -0.2, 2.0}));
  scene::WorldGeometry singleSided = disc;
  singleSided.reflectors[0].doubleSided = false;
  EXPECT_FALSE(isSeenFromBehind(singleSided, 0, {0.3, -0.2, 2.0}));
  const scene::WorldGeometry pipe = makeDoubleSided(geometry::makeCylinderSide(0.5, 2.0, 48, 4, false));
  EXPECT_FALSE(isSeenFromBehind(pipe, 0, {3.0, 0.5, 0.0}));
  EXPECT_TRUE(isSeenFromBehind(pipe, 0, {0.1, 0.3, 0.0}));
}

}  // namespace
}  // namespace catoptric::virtual_object
