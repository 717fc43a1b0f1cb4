// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/reference_camera.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace catoptric::depth_reflection_map {
namespace {

const MirrorWindow kWindow{{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {0.8, 0.4}};

TEST(ReferenceCamera, CornersOfTheImageAreCornersOfTheWidenedWindow) {
  const ReferenceCamera camera = makeReferenceCamera(kWindow, {-1, 2.5, 3.1}, 0.1, 180);
  EXPECT_EQ(camera.width, 180);
  EXPECT_EQ(camera.height, 100);
  EXPECT_NEAR(camera.planeDistance, 2.0, 1e-12);
  const dvec3 corner = camera.centre + camera.worldFromZexel * dvec3(0, 0, 1);
  EXPECT_NEAR(glm::length(corner - (kWindow.centre - 0.9 * kWindow.right - 0.5 * kWindow.up)), 0, 1e-12);
}

TEST(ReferenceCamera, ClipSpaceAndZexelsAgree) {
  const ReferenceCamera camera = makeReferenceCamera(kWindow, {-1, 2.5, 3.1}, 0.1, 180);
  const raster::PinholeView view = camera.makeView();
  for (const double disparity : {1.0, 0.6, 0.01}) {
    const dvec3 zexel(33.5, 70.5, 1);
    const dvec3 point = camera.centre + camera.worldFromZexel * zexel / disparity;
    EXPECT_NEAR(camera.planeDistance / glm::dot(point - camera.centre, camera.forward), disparity, 1e-12);
    const dvec4 clip = view.clipFromWorld * dvec4(point, 1);
    EXPECT_NEAR((clip.x / clip.w + 1) / 2 * camera.width, zexel.x, 1e-9);
    EXPECT_NEAR((clip.y / clip.w + 1) / 2 * camera.height, zexel.y, 1e-9);
    // Near plane on the mirror, far plane at infinity.
    EXPECT_NEAR(clip.z / clip.w, 1.0 - 2.0 * disparity, 1e-9);
  }
}

TEST(ReferenceCamera, HemisphereIsBehindTheWindowAndEven) {
  const auto points = makeHemisphere(kWindow, 2.0, 64).centres;
  ASSERT_EQ(points.size(), 64u);
  for (const dvec3& p : points) {
    EXPECT_NEAR(glm::length(p - kWindow.centre), 2.0, 1e-12);
    EXPECT_LE(glm::dot(p - kWindow.centre, kWindow.forward), -0.2 + 1e-12);
    double nearest = 1e300;
    for (const dvec3& q : points)
      if (&q != &p) nearest = std::min(nearest, glm::length(p - q));
    EXPECT_GT(nearest, 0.3);
    EXPECT_LT(nearest, 0.9);
  }
}

TEST(ReferenceCamera, InARoomImagesAreTakenWhereAMirroredEyeCanBe) {
  core::Box room;
  room.lower = {1, 1.5, 0}, room.upper = {6, 2.5, 6};  // the mirror hangs on its wall x = 1
  const Hemisphere all = makeHemisphere(kWindow, 2.0, 64), part = makeHemisphere(kWindow, 2.0, 64, &room);
  EXPECT_NEAR(double(part.centres.size()), 64.0, 4.0);
  EXPECT_LT(part.spacing, 0.7 * all.spacing);
  for (const dvec3& p : part.centres) {
    EXPECT_LT(p.x, 1.0);
    EXPECT_GE(p.y, room.lower.y);
    EXPECT_LE(p.y, room.upper.y);
  }
  // An eye outside of its box: over all of the hemisphere.
  room.lower = {20, 20, 20}, room.upper = {21, 21, 21};
  EXPECT_EQ(makeHemisphere(kWindow, 2.0, 64, &room).centres.size(), 64u);
}

}  // namespace
}  // namespace catoptric::depth_reflection_map
