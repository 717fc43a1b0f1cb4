// SPDX-License-Identifier: Apache-2.0
// Laws of the mouse: an orbit keeps the distance, a pan keeps what is under the mouse, zooming there and back
// ends where it began.
#include "viewer/camera_control.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "catoptric/scene/camera_frame.h"

namespace catoptric::viewer {
namespace {

scene::Camera makeCamera() {
  scene::Camera camera;
  camera.eye = dvec3(1, 2, 5);
  camera.target = dvec3(0.5, 1, -1);
  return camera;
}

dvec2 project(const scene::Camera& camera, const dvec3& point, int width, int height) {
  const scene::CameraFrame frame = scene::makeCameraFrame(camera, width, height);
  const dvec4 clip = frame.clipFromView(0.1) * frame.viewFromWorld() * dvec4(point, 1.0);
  return {(clip.x / clip.w + 1) * 0.5 * width, (1 - clip.y / clip.w) * 0.5 * height};
}

RC_GTEST_PROP(CameraControl, OrbitKeepsDistanceAndTarget, ()) {
  scene::Camera camera = makeCamera();
  const double distance = glm::length(camera.eye - camera.target);
  for (const int x : *rc::gen::container<std::vector<int>>(8, rc::gen::inRange(-2000, 2000))) {
    orbit(camera, dvec2(x, x / 3));
    RC_ASSERT(std::abs(glm::length(camera.eye - camera.target) - distance) < 1e-9 * distance);
    const dvec3 away = glm::normalize(camera.eye - camera.target);
    RC_ASSERT(std::abs(away.y) < 0.99996);  // never at a pole
  }
  RC_ASSERT(camera.target == makeCamera().target);
}

TEST(CameraControl, TheSceneFollowsTheMouse) {
  const scene::Camera before = makeCamera();
  const scene::CameraFrame frame = scene::makeCameraFrame(before, 640, 480);
  const dvec3 nearer = before.target + 0.2 * (before.eye - before.target);  // on the near side of the pivot
  for (const dvec2 mouse : {dvec2(10, 0), dvec2(0, 10)}) {
    scene::Camera camera = before;
    orbit(camera, mouse);
    const dvec2 moved = project(camera, nearer, 640, 480) - project(before, nearer, 640, 480);
    EXPECT_GT(glm::dot(moved, mouse), 0.0);
    EXPECT_NEAR(moved.x * mouse.y - moved.y * mouse.x, 0.0, 0.5);
  }
  EXPECT_NEAR(glm::dot(frame.right, frame.forward), 0.0, 1e-12);
}

RC_GTEST_PROP(CameraControl, PanKeepsThePivotUnderTheMouse, ()) {
  const scene::Camera before = makeCamera();
  scene::Camera camera = before;
  const dvec2 mouse(*rc::gen::inRange(-300, 300), *rc::gen::inRange(-300, 300));
  pan(camera, mouse, 480);
  const dvec2 moved = project(camera, before.target, 640, 480) - project(before, before.target, 640, 480);
  RC_ASSERT(glm::length(moved - mouse) < 1e-6);
}

TEST(CameraControl, ZoomThereAndBack) {
  scene::Camera camera = makeCamera();
  zoom(camera, 7);
  EXPECT_LT(glm::length(camera.eye - camera.target), glm::length(makeCamera().eye - makeCamera().target));
  zoom(camera, -7);
  EXPECT_LT(glm::length(camera.eye - makeCamera().eye), 1e-9);
}

TEST(CameraControl, FramesSeeAllOfTheScene) {
  core::Box bounds;
  bounds.add(dvec3(-1, 0, -2));
  bounds.add(dvec3(3, 1, 2));
  std::vector<scene::Camera> cameras{frameAll(makeCamera(), bounds)};
  for (const Side side : {Side::Front, Side::Right, Side::Top})
    cameras.push_back(frameFrom(side, makeCamera(), bounds));
  for (const scene::Camera& camera : cameras)
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 point(corner & 1 ? -1 : 3, corner & 2 ? 0 : 1, corner & 4 ? -2 : 2);
      const dvec2 at = project(camera, point, 480, 480);
      EXPECT_TRUE(at.x >= 0 && at.x <= 480 && at.y >= 0 && at.y <= 480)
          << camera.name << " corner " << corner;
    }
}

TEST(CameraControl, PivotAtTheEyeIsRefused) {
  scene::Camera camera = makeCamera();
  setPivot(camera, camera.eye);
  EXPECT_TRUE(isSameView(camera, makeCamera()));
  setPivot(camera, dvec3(0, 0, 0));
  EXPECT_EQ(camera.target, dvec3(0));
}

}  // namespace
}  // namespace catoptric::viewer
