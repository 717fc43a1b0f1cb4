// SPDX-License-Identifier: Apache-2.0
// The passes of a rasterised frame, one law each, on small scenes made by hand: what is seen at each pixel,
// through which mirrors, is compared with the ray tracer, which uses no matrix, no winding, no stencil and no
// sorting.
#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/renderer/near_plane.h"
#include "catoptric/renderer/raster_frame.h"
#include "gl_test_support.h"
#include "traced_scene.h"

namespace catoptric::gl::test {
namespace {

using reference::makeFacingQuad;
using reference::makeMirror;
using reference::makeQuad;
using reference::makeUnlit;
using reference::TracedTestScene;

constexpr int kSizePx = 96;

renderer::FrameOptions optionsFor(int bounces) {
  renderer::FrameOptions options;
  options.method = renderer::Method::Virtual;
  options.widthPx = options.heightPx = kSizePx;
  options.bounces = bounces;
  return options;
}

/// Mirrors drawn by GL, or their numbers and pixels by the processor.
enum class By { Gl, Processor };

renderer::Frame rasterizeBy(By by, const TracedTestScene& t, const scene::WorldGeometry& world, int bounces) {
  renderer::RasterFrame frame(GlTest::context(), t.scene, world, t.environment);
  frame.drawNumbersByGl(by == By::Gl);
  return frame.render(t.frame(kSizePx, kSizePx), optionsFor(bounces));
}

class RasterPass : public GlTest, public testing::WithParamInterface<By> {
 protected:
  static renderer::Frame rasterize(const TracedTestScene& t, int bounces = 1) {
    return rasterizeBy(GetParam(), t, t.world, bounces);
  }
};
INSTANTIATE_TEST_SUITE_P(By, RasterPass, testing::Values(By::Gl, By::Processor),
                         [](const auto& drawn) { return drawn.param == By::Gl ? "Gl" : "Processor"; });

bool isSame(const core::SeenPixel& a, const core::SeenPixel& b) {
  return a.object == b.object && a.firstReflector == b.firstReflector && a.bounces == b.bounces &&
         glm::length(a.point - b.point) < 2e-3f;
}

/// Share of pixels at which raster and ray tracer see the same point over the same mirrors.
double shareSame(const renderer::Frame& raster, const TracedTestScene& t, int bounces = 1) {
  const reference::TraceResult truth = t.trace(kSizePx, kSizePx, {.bounces = bounces});
  std::size_t same = 0;
  for (std::size_t i = 0; i < truth.seen.size(); ++i)
    same += isSame(raster.seen.pixels()[i], truth.seen.pixels()[i]) ? 1 : 0;
  return double(same) / double(truth.seen.size());
}

/// How many pixels show `object` after `bounces` mirrors.
std::size_t countSeen(const renderer::Frame& frame, std::uint32_t object, std::uint32_t bounces) {
  const auto& pixels = frame.seen.pixels();
  return std::size_t(std::count_if(pixels.begin(), pixels.end(), [&](const core::SeenPixel& p) {
    return p.object == object && p.bounces == bounces;
  }));
}

/// Edges may fall to either side of a pixel's centre: float against double.
constexpr double kSame = 0.998;

TEST_P(RasterPass, whatIsNearIsNotCutOff) {
  TracedTestScene t;
  reference::lookAtOrigin(t);
  t.add(makeFacingQuad(2.98f), makeUnlit(vec3(1)));                                 // 20 mm from the eye
  t.add(makeQuad({-40, -40, -40}, {80, 0, 0}, {0, 80, 0}), makeUnlit(vec3(0.5f)));  // makes the scene large
  t.finish();
  EXPECT_LT(renderer::chooseNearPlane(t.world, t.frame(kSizePx, kSizePx)), 0.02);
  const renderer::Frame frame = rasterize(t);
  EXPECT_EQ(countSeen(frame, 0, 0), frame.seen.size());
}

TEST_P(RasterPass, aFloorUnderTheEyeIsWhole) {
  TracedTestScene t;  // its triangles reach behind the eye
  t.camera.eye = {0, 0.05, 0};
  t.camera.target = {0, 0, -1};
  t.add(makeQuad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}), makeUnlit(vec3(1)));
  t.finish();
  const renderer::Frame frame = rasterize(t);
  EXPECT_GT(countSeen(frame, 0, 0), frame.seen.size() / 2);
  EXPECT_GE(shareSame(frame, t), kSame);
}

/// Mirror in z = 0 that faces +z, and a one-sided board before it that faces the mirror or the eye.
TracedTestScene makeBoardScene(bool facesMirror) {
  TracedTestScene t;
  t.camera.eye = {0.3, 0.2, 4};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.6;
  t.add(makeFacingQuad(0), makeMirror(), "mirror");
  const vec3 corner(-0.7f, -0.3f, 1.2f);
  t.add(facesMirror ? makeQuad(corner, {0, 0.8f, 0}, {0.8f, 0, 0})
                    : makeQuad(corner, {0.8f, 0, 0}, {0, 0.8f, 0}),
        makeUnlit(vec3(1, 0, 0)), "board");
  t.finish();
  return t;
}

TEST_P(RasterPass, aMirrorTurnsTheWindingRound) {
  const TracedTestScene facing = makeBoardScene(true), turned = makeBoardScene(false);
  const renderer::Frame seenInMirror = rasterize(facing), seenDirectly = rasterize(turned);
  EXPECT_EQ(countSeen(seenInMirror, 1, 0), 0u);  // its back, seen directly, is not drawn
  EXPECT_GT(countSeen(seenInMirror, 1, 1), 100u);
  EXPECT_GT(countSeen(seenDirectly, 1, 0), 100u);
  EXPECT_EQ(countSeen(seenDirectly, 1, 1), 0u);
  EXPECT_GE(shareSame(seenInMirror, facing), kSame);
  EXPECT_GE(shareSame(seenDirectly, turned), kSame);
}

TEST_P(RasterPass, twoMirrorsTurnItBack) {
  TracedTestScene t;
  t.camera.eye = {0.6, 0.1, 2.2};
  t.camera.target = {-0.115, 0, 0};
  t.camera.fovYRadians = 1.0;
  t.add(makeFacingQuad(0), makeMirror(), "back");
  t.add(makeQuad({1, -1, 3}, {-2, 0, 0}, {0, 2, 0}), makeMirror(), "front");  // faces -z
  t.add(makeQuad({-0.4f, -0.3f, 0.7f}, {0.5f, 0, 0}, {0, 0.5f, 0}), makeUnlit(vec3(0, 1, 0)), "board");
  t.finish();
  const renderer::Frame frame = rasterize(t, 4);
  EXPECT_GT(countSeen(frame, 2, 0), 50u);    // faces the eye
  EXPECT_EQ(countSeen(frame, 2, 1), 0u);     // the first mirror would show its back
  EXPECT_GT(countSeen(frame, 2, 2), 20u);    // the second its front again
  EXPECT_GE(shareSame(frame, t, 4), 0.995);  // four bounces, each with its edges
}

TEST_P(RasterPass, nothingBehindAMirrorIsReflectedInIt) {
  TracedTestScene t;
  t.camera.eye = {1.5, 0.5, 3};
  t.camera.target = {0, 0, 0};
  t.add(makeFacingQuad(0), makeMirror(), "mirror");
  scene::Material twoSided = makeUnlit(vec3(0, 0, 1));
  twoSided.doubleSided = true;
  t.add(makeQuad({0.2f, -0.5f, 0.8f}, {0, 0, -1.6f}, {0, 1, 0}), twoSided,
        "through");  // half before, half behind
  t.add(makeFacingQuad(-0.5f), twoSided, "behind");
  t.finish();
  const renderer::Frame frame = rasterize(t);
  EXPECT_GT(countSeen(frame, 1, 1), 100u);
  EXPECT_EQ(countSeen(frame, 2, 1), 0u);
  for (const core::SeenPixel& p : frame.seen.pixels())
    EXPECT_FALSE(p.bounces == 1 && p.object == 1 && p.point.z < -1e-3f) << p.point.z;
  EXPECT_GE(shareSame(frame, t), kSame);
}

/// Three mirrors at angles around a ball: chains of every order.
TracedTestScene makeCorner() {
  TracedTestScene t;
  t.camera.eye = {2.2, 1.4, 2.6};
  t.camera.target = {0.3, 0.3, 0.3};
  t.camera.fovYRadians = 0.8;
  t.add(makeQuad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), makeMirror(vec3(1, 0.6f, 0.6f)), "red");
  t.add(makeQuad({0, 0, 2}, {0, 0, -2}, {0, 2, 0}), makeMirror(vec3(0.6f, 1, 0.6f)), "green");
  t.add(makeQuad({0, 0, 2}, {2, 0, 0}, {0, 0, -2}), makeUnlit(vec3(0.3f)), "floor");
  t.add(makeQuad({0.5f, 0, 0.6f}, {0.5f, 0, -0.3f}, {0, 0.8f, 0}), makeUnlit(vec3(0.2f, 0.4f, 1)), "board");
  t.finish();
  return t;
}

TEST_P(RasterPass, eachChainKeepsToItsMask) {
  const TracedTestScene t = makeCorner();
  const renderer::Frame frame = rasterize(t, 3);
  for (std::uint32_t bounces = 0; bounces < 3; ++bounces)
    EXPECT_GT(countSeen(frame, 2, bounces), 50u) << bounces;
  EXPECT_GE(shareSame(frame, t, 3), 0.995);
}

/// Their rectangles overlap, and none may overwrite what another one has added.
TEST_F(GlTest, mirrorsThatAreAddedTogetherLeaveEachOtherAlone) {
  TracedTestScene t = makeCorner();
  t.camera.up = {1, 1, 0};  // so that the edge between the mirrors is slanted
  const auto render = [&](bool withSeen) {
    renderer::RasterFrame frame(GlTest::context(), t.scene, t.world, t.environment);
    frame.drawNumbersByGl(false);
    renderer::FrameOptions options = optionsFor(1);
    options.withSeen = withSeen;  // colour alone is added, all mirrors at once
    return frame.render(t.frame(kSizePx, kSizePx), options).radiance;
  };
  const core::ImageRgbaF added = render(false), drawn = render(true);
  const reference::TraceResult truth = t.trace(kSizePx, kSizePx, {.bounces = 1});
  std::size_t other = 0, mirrors = 0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(added.pixels()[i][k], drawn.pixels()[i][k], 1e-5f) << i;
    mirrors += truth.seen.pixels()[i].bounces > 0 ? 1 : 0;
    other += glm::length(vec3(added.pixels()[i]) - vec3(truth.radiance.pixels()[i])) > 0.01f ? 1 : 0;
  }
  EXPECT_GT(mirrors, added.size() / 5);
  EXPECT_LT(other, added.size() / 200);
}

/// By the processor it nearly would: what a pixel shows is where its own ray goes.
TEST_F(GlTest, aTiltedPlaneDoesNotPass) {
  const TracedTestScene t = makeCorner();
  scene::WorldGeometry wrong = t.world;
  core::Plane& plane = wrong.reflectors[0].plane;
  plane.normal = glm::normalize(plane.normal + dvec3(0, 0.01, 0));
  EXPECT_LT(shareSame(rasterizeBy(By::Gl, t, wrong, 3), t, 3), 0.9);
}

/// Three sheets of glass one behind the other, in the order given, before a mirror.
TracedTestScene makeGlass(const std::array<int, 3>& order) {
  TracedTestScene t;
  reference::lookAtOrigin(t);
  t.camera.fovYRadians = 0.3;
  t.add(makeQuad({-4, -4, -4}, {8, 0, 0}, {0, 8, 0}), makeMirror(), "mirror");
  const std::array<vec3, 3> colors{vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
  for (const int sheet : order) {
    scene::Material glass = makeUnlit(colors[std::size_t(sheet)]);
    glass.baseColor.a = 0.25f + 0.125f * float(sheet);
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.doubleSided = true;
    t.add(makeFacingQuad(-0.5f * float(sheet)), glass);
  }
  t.finish();
  return t;
}

TEST_P(RasterPass, blendedSurfacesLieOverEachOtherFromFarToNear) {
  // Sheet 0 is the nearest. Through the mirror the order is the other way round: it lies farthest.
  const auto over = [](int sheet, const vec3& below) {
    const float alpha = 0.25f + 0.125f * float(sheet);
    vec3 color(0);
    color[sheet] = 1;
    return alpha * color + (1 - alpha) * below;
  };
  for (const std::array<int, 3>& order : {std::array{0, 1, 2}, std::array{2, 0, 1}, std::array{1, 2, 0}}) {
    const TracedTestScene t = makeGlass(order);
    const vec3 sky(0.25f, 0.5f, 1.0f);
    const vec3 inMirror = over(2, over(1, over(0, sky)));
    const vec3 expected = over(0, over(1, over(2, inMirror)));
    const vec3 seen(rasterize(t).radiance.at(kSizePx / 2, kSizePx / 2));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], expected[k], 1e-5f) << order[0] << order[1] << order[2];
  }
}

TEST_P(RasterPass, anEmptySceneShowsTheSky) {
  TracedTestScene t;
  t.finish();
  const renderer::Frame frame = rasterize(t);
  for (const core::SeenPixel& p : frame.seen.pixels()) EXPECT_TRUE(p.isSky());
  reference::expectColor(frame.radiance.at(3, 3), vec3(0.25f, 0.5f, 1.0f), 1e-3f);
}

}  // namespace
}  // namespace catoptric::gl::test
