// SPDX-License-Identifier: Apache-2.0
// What mirrors show is kept within them in six ways: all of them show the same.
#include <array>

#include "catoptric/renderer/raster_frame.h"
#include "gl_test_support.h"
#include "traced_scene.h"

namespace catoptric::gl::test {
namespace {

using reference::makeMirror;
using reference::makeQuad;
using reference::makeUnlit;
using reference::TracedTestScene;
using renderer::Merge;
using MergeTest = GlTest;

constexpr int kSizePx = 128;
constexpr std::array kOthers{Merge::Stencil, Merge::Erase, Merge::Depth, Merge::Clip, Merge::Texture};

/// Mirrors before, beside and in each other, one of them round, and a sheet of glass before a wall.
TracedTestScene makeScene(bool withBall) {
  TracedTestScene t;
  t.camera.eye = {2.2, 1.4, 2.6};
  t.camera.target = {0.3, 0.3, 0.3};
  t.camera.fovYRadians = 0.8;
  t.add(makeQuad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), makeMirror(vec3(1, 0.6f, 0.6f)), "red");
  t.add(makeQuad({0, 0, 2}, {0, 0, -2}, {0, 2, 0}), makeMirror(vec3(0.6f, 1, 0.6f)), "green");
  t.add(makeQuad({1.3f, 0.1f, 0.8f}, {0.5f, 0, -0.4f}, {0, 0.6f, 0}), makeMirror(), "before them");
  t.add(makeQuad({0, 0, 2}, {2, 0, 0}, {0, 0, -2}), makeUnlit(vec3(0.3f, 0.2f, 0.1f)), "floor");
  t.add(makeQuad({0.5f, 0, 0.6f}, {0.5f, 0, -0.3f}, {0, 0.8f, 0}), makeUnlit(vec3(0.2f, 0.4f, 1)), "board");
  scene::Material glass = makeUnlit(vec3(1, 1, 0));
  glass.baseColor.a = 0.5f;
  glass.alphaMode = scene::AlphaMode::Blend;
  glass.doubleSided = true;
  t.add(makeQuad({0.2f, 0.3f, 1.4f}, {0.9f, 0, 0.1f}, {0, 0.5f, 0}), glass, "glass");
  if (withBall)
    t.add(reference::makeBall(48, 32), makeMirror(), "ball",
          glm::translate(dmat4(1.0), dvec3(1.1, 0.9, 0.9)) * glm::scale(dmat4(1.0), dvec3(0.35)));
  t.finish();
  return t;
}

/// One for all ways, whose programs take longer to compile than the pictures to draw.
renderer::RasterFrame makeRasterFrame(const TracedTestScene& t) {
  return renderer::RasterFrame(GlTest::context(), t.scene, t.world, t.environment);
}

renderer::Frame render(const TracedTestScene& t, renderer::RasterFrame& frame, Merge merge,
                       renderer::Solver solver, double scale = 1) {
  renderer::FrameOptions options;
  options.method = renderer::Method::Virtual;
  options.solver = solver;
  options.widthPx = options.heightPx = kSizePx;
  options.bounces = 3;
  options.merge = merge;
  options.textureScale = scale;
  return frame.render(t.frame(kSizePx, kSizePx), options);
}

/// How many pixels differ in what is seen, or in colour by more than 1/255.
std::size_t countDifferent(const renderer::Frame& a, const renderer::Frame& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.seen.size(); ++i) {
    const core::SeenPixel &p = a.seen.pixels()[i], &q = b.seen.pixels()[i];
    const vec4 change = glm::abs(a.radiance.pixels()[i] - b.radiance.pixels()[i]);
    const bool isSame = p.object == q.object && p.firstReflector == q.firstReflector &&
                        p.bounces == q.bounces && glm::length(p.point - q.point) < 1e-3f &&
                        std::max({change.r, change.g, change.b}) < 1.0f / 255.0f;
    count += isSame ? 0 : 1;
  }
  return count;
}

TEST_F(MergeTest, flatMirrorsShowTheSameHoweverTheyAreMerged) {
  const TracedTestScene t = makeScene(false);
  renderer::RasterFrame raster = makeRasterFrame(t);
  const renderer::Frame ids = render(t, raster, Merge::Ids, renderer::Solver::Auto);
  // Where an edge passes through a pixel's centre, rounding decides.
  for (const Merge merge : kOthers)
    EXPECT_LE(countDifferent(ids, render(t, raster, merge, renderer::Solver::Auto)), ids.seen.size() / 1000)
        << renderer::mergeName(merge);
}

TEST_F(MergeTest, soDoCurvedOnes) {
  const TracedTestScene t = makeScene(true);
  renderer::RasterFrame raster = makeRasterFrame(t);
  for (const renderer::Solver solver : {renderer::Solver::Layered, renderer::Solver::Refined}) {
    const renderer::Frame ids = render(t, raster, Merge::Ids, solver);
    for (const Merge merge : kOthers)
      EXPECT_LE(countDifferent(ids, render(t, raster, merge, solver)), ids.seen.size() / 1000)
          << renderer::mergeName(merge) << ", " << renderer::solverName(solver);
  }
}

/// The box of what pixels of the same object show around (x, y), two pixels each way.
core::Box findNeighbours(const core::SeenImage& seen, int x, int y) {
  core::Box box;
  for (int j = std::max(y - 2, 0); j <= std::min(y + 2, kSizePx - 1); ++j)
    for (int i = std::max(x - 2, 0); i <= std::min(x + 2, kSizePx - 1); ++i)
      if (seen.at(i, j).object == seen.at(x, y).object) box.add(dvec3(seen.at(i, j).point));
  return box;
}

TEST_F(MergeTest, aCoarserTextureBlursButDoesNotMove) {
  const TracedTestScene t = makeScene(false);
  renderer::RasterFrame raster = makeRasterFrame(t);
  const renderer::Frame fine = render(t, raster, Merge::Texture, renderer::Solver::Auto);
  const renderer::Frame coarse = render(t, raster, Merge::Texture, renderer::Solver::Auto, 0.5);
  EXPECT_GT(countDifferent(fine, coarse), fine.seen.size() / 20);
  std::size_t inMirror = 0, near = 0;
  for (int y = 0; y < kSizePx; ++y)
    for (int x = 0; x < kSizePx; ++x) {
      const core::SeenPixel &p = fine.seen.at(x, y), &q = coarse.seen.at(x, y);
      if (p.bounces != 1 || p.isSky()) continue;
      ++inMirror;
      const core::Box box = findNeighbours(fine.seen, x, y);
      const dvec3 point(q.point), margin(1e-3);
      near += p.object == q.object && glm::all(glm::greaterThan(point, box.lower - margin)) &&
                      glm::all(glm::lessThan(point, box.upper + margin))
                  ? 1
                  : 0;
    }
  EXPECT_GT(double(near), 0.9 * double(inMirror));  // the others lie at edges
}

}  // namespace
}  // namespace catoptric::gl::test
