// SPDX-License-Identifier: Apache-2.0
// Sketches: what is drawn lies where the camera sees it, what is behind something is hidden, and what a
// sketch says of a mirror obeys the mirror law.
#include "catoptric/sketch/sketch.h"

#include <gtest/gtest.h>

#include <limits>

#include "catoptric/geometry/shapes.h"
#include "catoptric/sketch/mirror_sketch.h"
#include "catoptric/sketch/section.h"
#include "catoptric/sketch/zexel_sketch.h"

namespace catoptric::sketch {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

scene::CameraFrame makeCamera() {
  scene::Camera camera;
  camera.eye = {0, 0, 3}, camera.target = {0, 0, 0}, camera.fovYRadians = 0.9;
  return scene::makeCameraFrame(camera, 64, 48);
}

struct Canvas {
  core::ImageRgba8 picture{64, 48, glm::u8vec4(255)};
  DistanceImage distances{64, 48, kNothing};
};

TEST(Sketch, ADotLiesWhereTheCameraSeesIt) {
  const scene::CameraFrame camera = makeCamera();
  for (const dvec2 pixel : {dvec2(10.5, 7.5), dvec2(32.5, 24.5), dvec2(60.5, 40.5)}) {
    Canvas canvas;
    Sketch sketch;
    sketch.addDot(camera.eye + 2.0 * camera.rayDirection(pixel.x, pixel.y), kRed, 0.8f);
    drawSketch(sketch, camera, canvas.picture, canvas.distances);
    EXPECT_EQ(canvas.picture.at(int(pixel.x), int(pixel.y)), kRed);
    EXPECT_EQ(canvas.picture.at(int(pixel.x) > 32 ? 2 : 62, 24), glm::u8vec4(255));
  }
}

TEST(Sketch, AFaceHasTheDistanceOfItsPlaneAndHidesWhatIsBehind) {
  const scene::CameraFrame camera = makeCamera();
  Canvas canvas;
  Sketch sketch;
  sketch.addFace({-9, -9, 1}, {9, -9, 1}, {0, 12, 1}, kBlue);
  sketch.addLine({-0.5, 0, 0}, {0.5, 0, 0}, kRed, 3);
  drawSketch(sketch, camera, canvas.picture, canvas.distances);
  const dvec3 ray = camera.rayDirection(20.5, 30.5);
  EXPECT_NEAR(double(canvas.distances.at(20, 30)), 2.0 * glm::length(ray), 1e-5);
  EXPECT_EQ(canvas.picture.at(20, 30), kBlue);
  const glm::u8vec4 behind = canvas.picture.at(32, 24);
  EXPECT_GT(int(behind.b), int(behind.r)) << "faint";
  EXPECT_GT(int(behind.r), int(kBlue.r)) << "but there";

  Canvas twin;  // the same line before the face
  sketch.lines.front().from.z = sketch.lines.front().to.z = 1.5f;
  drawSketch(sketch, camera, twin.picture, twin.distances);
  EXPECT_EQ(twin.picture.at(32, 24), kRed);
}

TEST(Sketch, NothingBeforeTheEyeOrBehindItOrNotFiniteIsDrawn) {
  const scene::CameraFrame camera = makeCamera();
  Canvas canvas;
  Sketch sketch;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  sketch.addLine({0, 0, 4}, {1, 0, 9}, kRed);
  sketch.addDot({0, 0, 5}, kRed);
  sketch.addFace({0, 0, 4}, {1, 0, 4}, {0, 1, 5}, kRed);
  sketch.addFace({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, kRed);
  sketch.addLine({nan, 0, 0}, {1, 0, 0}, kRed);
  drawSketch(sketch, camera, canvas.picture, canvas.distances);
  for (const glm::u8vec4& pixel : canvas.picture.pixels()) EXPECT_EQ(pixel, glm::u8vec4(255));
}

TEST(Sketch, PicturesSideBySideAreAsTallAsTheTallest) {
  const core::ImageRgba8 row =
      putSideBySide({core::ImageRgba8(10, 20, kRed), core::ImageRgba8(5, 10, kBlue)}, 3);
  EXPECT_EQ(row.width(), 10 + 3 + 10);
  EXPECT_EQ(row.height(), 20);
  EXPECT_EQ(row.at(0, 19), kRed);
  EXPECT_EQ(row.at(22, 19), kBlue);
  EXPECT_EQ(putSideBySide({}).size(), 0u);
}

class SphereSketch : public ::testing::Test {
 protected:
  const dvec3 eye{0, 0, 4};
  const geometry::Mesh sphere = geometry::makeIcosphere(1.0, 8);
  const virtual_object::ReflectorMesh mesh{sphere.positions, sphere.normals, sphere.indices};
  const virtual_object::VirtualObjectSolver solver{mesh, eye, 10.0};
  const Section section = makeSection(mesh, eye, {0, 1, 0}, 12.0, 120, 90);
};

TEST_F(SphereSketch, CellsOfASectionAreThoseOfTheSubdivision) {
  const core::ImageRgba8 cells = drawCells(mesh, eye, section);
  EXPECT_NE(cells.at(30, 45), glm::u8vec4(255)) << "between eye and mirror: reflected";
  const glm::u8vec4 hidden = cells.at(110, 45), reflected = cells.at(30, 10);
  EXPECT_LT(int(hidden.r) + hidden.g + hidden.b, int(reflected.r) + reflected.g + reflected.b);
  // Left to right on the axis: all reflected, then all hidden, as long as a closed convex mirror is asked.
  EXPECT_NE(cells.at(100, 44), cells.at(30, 44));
}

TEST_F(SphereSketch, AReflectedPointObeysTheMirrorLaw) {
  const dvec3 point(1.5, 1.0, 1.5);
  const Sketch sketch = sketchReflectedPoint(solver, point);
  ASSERT_EQ(sketch.lines.size(), 3u);  // eye - J, J - Q, J - Q'
  const dvec3 j(sketch.lines[0].to), normal = glm::normalize(j);
  const dvec3 mirrored = core::reflectDirection(glm::normalize(j - eye), normal);
  EXPECT_LT(glm::length(mirrored - glm::normalize(point - j)), 0.02) << "facets against the sphere";
  EXPECT_NEAR(double(glm::length(sketch.lines[2].to - sketch.lines[2].from)), glm::length(point - j), 1e-4);
}

TEST_F(SphereSketch, ACellIsDrawnOnlyWhereTheMirrorFacesTheEye) {
  const auto seen = findTriangleOf(solver, {1.5, 1.0, 1.5});
  ASSERT_TRUE(seen);
  EXPECT_TRUE(sketchCell(mesh, eye, *seen, 2.0));
  std::uint32_t behind = 0;
  for (std::uint32_t t = 0; t < mesh.ordinaryCount(); ++t)
    if (mesh.triangles()[t].position(0.3, 0.3).z < -0.9) behind = t;
  EXPECT_FALSE(sketchCell(mesh, eye, behind, 2.0));
}

TEST_F(SphereSketch, MapsHaveOneColourATriangleAndBlackOutsideTheCircle) {
  const std::vector<Colour> colours = colourTriangles(mesh);
  ASSERT_EQ(colours.size(), mesh.triangles().size());
  const core::ImageRgba8 map = drawMap(solver.nearMap().ids, true, colours);
  EXPECT_EQ(map.at(0, 0), glm::u8vec4(0, 0, 0, 255));
  EXPECT_NE(map.at(map.width() / 2, map.height() / 2), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(drawMaps(solver).height(), solver.nearMap().ids.height());
}

TEST(Exposures, AreMirrorPixelsWithTheSkyWhereTheTruthHasASurface) {
  core::SeenImage seen(4, 1), truth(4, 1);
  for (int x = 0; x < 3; ++x) seen.at(x, 0).firstReflector = truth.at(x, 0).firstReflector = 0;
  truth.at(0, 0).object = 5;                         // exposed
  seen.at(1, 0).object = truth.at(1, 0).object = 5;  // covered
  truth.at(3, 0).object = 5;                         // no mirror; (2, 0) is sky in both
  core::ImageRgba8 picture(4, 1, glm::u8vec4(9));
  EXPECT_EQ(markExposures(seen, truth, picture), 1u);
  EXPECT_EQ(picture.at(0, 0), glm::u8vec4(255, 0, 255, 255));
  for (int x = 1; x < 4; ++x) EXPECT_EQ(picture.at(x, 0), glm::u8vec4(9));
}

}  // namespace
}  // namespace catoptric::sketch
