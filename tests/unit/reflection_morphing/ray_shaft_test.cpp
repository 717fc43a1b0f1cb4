// SPDX-License-Identifier: Apache-2.0
// The shaft of a trace holds whatever the trace shows, and little else.
#include "catoptric/reflection_morphing/ray_shaft.h"

#include <gtest/gtest.h>

#include "catoptric/reflection_morphing/find_ray.h"
#include "mirror_world.h"

namespace catoptric::reflection_morphing {
namespace {

using namespace test;

const dvec3 kEye(0.4, 0.3, 2.1);

/// The part of a ball of 4 m that looks towards +z: a mirror that shows little of the world.
scene::WorldGeometry makeNarrowMirror() {
  geometry::Mesh ball = makeSphereAt({0, 0, -4}, 4, 96), cap;
  cap.positions = ball.positions;
  cap.normals = ball.normals;
  for (std::size_t i = 0; i < ball.indices.size(); i += 3) {
    const std::uint32_t* v = &ball.indices[i];
    if (glm::length(vec2(ball.positions[v[0]])) < 0.4f && ball.positions[v[0]].z > -1)
      cap.indices.insert(cap.indices.end(), v, v + 3);
  }
  scene::WorldGeometry world = makeMirrorWorld({cap});
  world.reflectors[0].centre = dvec3(0);
  world.reflectors[0].radius = 0.5;
  return world;
}

std::shared_ptr<const SamplingLocation> sample(const scene::WorldGeometry& world) {
  return makeLocation(MirrorRays(world), kEye, makeOptions(world, 128));
}

TEST(RayShaft, holdsAllThatIsReflected) {
  const scene::WorldGeometry world = makeNarrowMirror();
  const MirrorRays rays(world);
  const auto location = sample(world);
  ASSERT_EQ(location->traces.size(), 1u);
  const RayShaft& shaft = location->traces[0].shaft;
  const auto points = makeKnownPoints(rays, kEye, {0}, 5000, 17);
  ASSERT_EQ(points.size(), 5000u);
  for (const KnownPoint& known : points) {
    EXPECT_TRUE(shaft.mayReach(vec3(known.scenePoint)));
    const dvec3 far = known.mirrorPoint + 400.0 * (known.scenePoint - known.mirrorPoint);
    EXPECT_TRUE(shaft.mayReach(vec3(far)));
  }
}

/// The twin: most points in front of the mirror are not reflected, and it says so of nearly all of them.
TEST(RayShaft, holdsLittleElse) {
  const auto location = sample(makeNarrowMirror());
  const SampledTrace& trace = location->traces.at(0);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-3, 3);
  int reflected = 0, held = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3 q(uniform(random), uniform(random), std::abs(uniform(random)));
    const bool isHeld = trace.shaft.mayReach(q);
    const OctreeRay& ray = findNearestRay(trace.octree, trace.octree.findLeaf(q), q);
    const FoundRay found = findRay(trace.table, q, {ray.x, ray.y});
    EXPECT_TRUE(isHeld || !found.isInside);
    held += isHeld ? 1 : 0;
    reflected += found.isInside ? 1 : 0;
  }
  EXPECT_GT(reflected, 500);
  EXPECT_LT(held, reflected + reflected / 2);  // a third: the corners of the shaft and two texels around
}

TEST(RayShaft, ofRaysInAllDirectionsHoldsEverything) {
  const auto location = sample(makeSphereWorld());
  for (const float z : {-100.0f, 0.0f, 100.0f})
    EXPECT_TRUE(location->traces.at(0).shaft.mayReach(vec3(3, -50, z)));
  EXPECT_TRUE(makeRayShaft(RayMap{}).mayReach(vec3(1, 2, 3)));
}

}  // namespace
}  // namespace catoptric::reflection_morphing
