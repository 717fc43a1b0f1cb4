// SPDX-License-Identifier: Apache-2.0
// Same picture on every run; odd input gives a sane picture or one clear error.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "catoptric/core/error.h"
#include "catoptric/core/parallel.h"
#include "catoptric/reference/ray_tracer.h"
#include "traced_scene.h"

namespace catoptric::reference {
namespace {

TracedTestScene makeBusyScene() {
  TracedTestScene t;
  t.scene.textures.push_back(makeChecker(4, 8));
  scene::Material floor;
  floor.metallic = 0;
  floor.baseColorTexture.texture = 0;
  t.add(makeQuad({-9, -1, 9}, {18, 0, 0}, {0, 0, -18}, 4), floor, "floor");
  for (const double x : {-1.1, 1.1})
    for (const double z : {-1.1, 1.1})
      t.add(makeBall(48, 24), makeMirror(), "ball", glm::translate(dmat4(1), dvec3(x, 0, z)));
  t.camera.eye = {1, 2, 7};
  t.finish();
  return t;
}

template <class Pixel>
bool equalBytes(const core::Image<Pixel>& a, const core::Image<Pixel>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
}

TEST(RayTracer, SameBytesOnEveryRunAndThreadCount) {
  const TracedTestScene t = makeBusyScene();
  const TraceOptions options{.bounces = 3, .samples = 2};
  const TraceResult first = t.trace(101, 67, options), second = t.trace(101, 67, options);
  core::setThreadCount(1);
  const TraceResult alone = t.trace(101, 67, options);
  const TracedTestScene rebuilt = makeBusyScene();
  const TraceResult again = rebuilt.trace(101, 67, options);
  core::setThreadCount(0);
  for (const TraceResult* other : {&second, &alone, &again}) {
    EXPECT_TRUE(equalBytes(first.radiance, other->radiance));
    EXPECT_TRUE(equalBytes(first.seen, other->seen));
    EXPECT_TRUE(equalBytes(first.footprints, other->footprints));
    EXPECT_EQ(first.rays, other->rays);
  }
}

TEST(RayTracer, SamplesChangeRadianceButNotWhatIsSeen) {
  const TracedTestScene t = makeBusyScene();
  const TraceResult one = t.trace(64, 48), eight = t.trace(64, 48, {.samples = 8});
  EXPECT_TRUE(equalBytes(one.seen, eight.seen));
  EXPECT_TRUE(equalBytes(one.footprints, eight.footprints));
  EXPECT_FALSE(equalBytes(one.radiance, eight.radiance));
  double meanOne = 0, meanEight = 0;
  for (std::size_t i = 0; i < one.radiance.size(); ++i) {
    meanOne += one.radiance.data()[i].g;
    meanEight += eight.radiance.data()[i].g;
    EXPECT_EQ(eight.radiance.data()[i].a, 1);
  }
  EXPECT_NEAR(meanOne / meanEight, 1, 0.01);
  const TraceResult bare = t.trace(64, 48, {.withSeen = false, .withFootprints = false});
  EXPECT_TRUE(bare.seen.isEmpty() && bare.footprints.isEmpty());
  EXPECT_TRUE(equalBytes(one.radiance, bare.radiance));
}

TEST(RayTracer, OddNormalsAndGrazingViewsGiveNoNan) {
  TracedTestScene t;
  scene::MeshPrimitive quad = makeQuad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  quad.normals = {vec3(0, 1, 0), vec3(0, -1, 0), vec3(1, 0, 0), vec3(-1, 0, 0)};  // cancel in the middle
  t.scene.textures.push_back(makeChecker(2, 2));
  scene::Material material = makeMirror();
  material.doubleSided = true;
  material.normalTexture.texture = 0;  // half its texels are no direction at all
  t.add(quad, material, "twisted");
  scene::Material rough;
  rough.metallic = 0;
  rough.doubleSided = true;
  quad.normals.assign(4, vec3(0, 1, 0));
  t.add(quad, rough, "floor", glm::translate(dmat4(1), dvec3(0, -1, 0)));
  scene::Light light;
  light.position = {0, 0, 0};
  t.scene.lights.push_back(light);
  t.finish();
  for (const dvec3& eye :
       {dvec3(0, 0, 5), dvec3(0, 1e-7, 5), dvec3(0, 3, 0.001), dvec3(0, 0, 0), dvec3(1e9, 1, 0)}) {
    t.camera.eye = eye;
    t.camera.target = eye + dvec3(0, -1e-4, -1);
    const TraceResult result = t.trace(64, 64, {.bounces = 4});
    for (const vec4& pixel : result.radiance.pixels())
      EXPECT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    for (const core::Footprint& f : result.footprints.pixels())
      EXPECT_TRUE(std::isfinite(glm::dot(f.dPdx, vec3(1))) && std::isfinite(glm::dot(f.dPdy, vec3(1))));
  }
}

TEST(RayTracer, TouchingTheMirrorIsSeenInIt) {
  // A ball that rests on a mirror floor: its image touches it.
  TracedTestScene t;
  t.add(makeQuad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), makeMirror(), "floor");
  t.add(makeBall(128, 64), makeUnlit({1, 0, 0}), "ball", glm::translate(dmat4(1), dvec3(0, 1, 0)));
  t.camera.eye = {0, 0.3, 6};
  t.camera.target = {0, 0, 0};
  t.finish();
  const TraceResult result = t.trace(65, 65);
  for (int y = 24; y < 41; ++y) EXPECT_EQ(result.seen.at(32, y).object, 1u) << y;
}

TEST(RayTracer, NonFiniteVerticesAreLeftOut) {
  TracedTestScene t;
  t.add(makeFacingQuad(), makeUnlit({0, 1, 0}), "quad");
  t.add(makeFacingQuad(1), makeUnlit({1, 0, 0}), "broken");
  t.finish();
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       1e30f};
  for (const float value : bad) {
    t.world.positions[4].x = value;
    t.world.positions[6].y = value;
    t.tracer = std::make_unique<RayTracer>(t.scene, t.world, t.environment);
    lookAtOrigin(t);
    expectColor(centreOf(t.trace(31, 31)), {0, 1, 0});
  }
}

TEST(RayTracer, NonFiniteCameraIsRefused) {
  TracedTestScene t = makeBusyScene();
  scene::CameraFrame frame = t.frame(20, 20);
  frame.eye.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)t.tracer->trace(frame, {}), core::Error);
  frame = t.frame(20, 20);
  frame.forward = frame.right = frame.up = dvec3(0);
  EXPECT_THROW((void)t.tracer->trace(frame, {}), core::Error);
}

TEST(RayTracer, SaysWhatItRunsOn) {
  TracedTestScene t;
  t.finish();
  EXPECT_NE(t.tracer->describe().find("Embree 3."), std::string::npos);
}

}  // namespace
}  // namespace catoptric::reference
