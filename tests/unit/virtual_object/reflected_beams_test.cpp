// SPDX-License-Identifier: Apache-2.0
// Culling of what a mirror cannot reflect: nothing is lost. The twin has a cone that is too narrow, and must
// lose some.
#include "catoptric/virtual_object/reflected_cone.h"

#include <gtest/gtest.h>

#include <random>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "reflection_harness.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

/// A cap of a ball around the origin that bulges towards +z, as a wing mirror does; `sign` -1: hollow.
geometry::Mesh makeCap(double radius, double halfWidth, float sign, double halfHeight = 0) {
  geometry::Mesh mesh =
      geometry::makePlane(2 * halfWidth, 2 * (halfHeight > 0 ? halfHeight : halfWidth), 12, 12);
  for (vec3& p : mesh.positions)
    p = vec3(p.x, -p.z, sign * std::sqrt(float(radius * radius) - p.x * p.x - p.z * p.z));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.normals[i] = sign * glm::normalize(mesh.positions[i]);
  return mesh;
}

struct Counts {
  int reflected = 0, lost = 0, culled = 0;
};

/// Random points all around; `narrow` scales the cone.
Counts countLost(const ReflectorMesh& mesh, const dvec3& eye, double narrow) {
  const VirtualObjectSolver solver(mesh, eye, 20);
  ReflectedCone cone = solver.reflectedCone();
  cone.halfAngleRadians *= narrow;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> logDistance(std::log(1.5), std::log(15.0));
  Counts counts;
  for (int i = 0; i < 4000; ++i) {
    const dvec3 point = mesh.centre() + randomDirection(random) * std::exp(logDistance(random));
    const auto found = solver.findReflectionPoint(Solver::Refined, point);
    const bool isReflected = found && found->kind == VertexKind::Reflected;
    const bool isKept = cone.mayMeet(point, 0);
    counts.reflected += isReflected;
    counts.lost += isReflected && !isKept;
    counts.culled += !isKept;
  }
  return counts;
}

TEST(ReflectedCone, HoldsEveryReflectedPoint) {
  for (const dvec3& eye : {dvec3(0.5, 0.2, 4), dvec3(-2, 1, 2.5)}) {
    const Counts convex = countLost(meshOf(makeCap(2, 0.4, 1)), eye, 1);
    EXPECT_EQ(convex.lost, 0);
    EXPECT_GT(convex.reflected, 100);
    EXPECT_GT(convex.culled, 1000);
    EXPECT_GT(countLost(meshOf(makeCap(2, 0.4, 1)), eye, 0.5).lost, 0);
  }
  const Counts hollow = countLost(meshOf(makeCap(8, 1.2, -1)), dvec3(0.5, 0.2, -4), 1);
  EXPECT_EQ(hollow.lost, 0);
  EXPECT_GT(hollow.reflected, 20);
}

TEST(ReflectedCone, SidesLieCloserThanTheConeAndLoseNothing) {
  const ReflectorMesh mesh = meshOf(makeCap(2, 0.6, 1, 0.15));
  for (const dvec3& eye : {dvec3(0.5, 0.2, 4), dvec3(-1, 0.6, 3)}) {
    EXPECT_EQ(countLost(mesh, eye, 1).lost, 0);
    ReflectedCone cone = VirtualObjectSolver(mesh, eye, 20).reflectedCone();
    ASSERT_TRUE(cone.sides.has_value());
    ReflectedCone round = cone;
    round.sides.reset();
    std::mt19937 random(5);
    int met = 0, metByRound = 0;
    for (int i = 0; i < 20000; ++i) {
      const dvec3 point = cone.centre + 12.0 * randomDirection(random);
      met += cone.mayMeet(point, 0), metByRound += round.mayMeet(point, 0);
    }
    EXPECT_LT(met, 0.7 * metByRound);
  }
}

TEST(ReflectedCone, OfARectangleOfAPictureHoldsWhatItShows) {
  const dvec3 eye(1, 2, 3);
  const dmat4 clip =
      glm::perspective(0.9, 1.5, 0.1, 100.0) * glm::lookAt(eye, dvec3(-2, 0, 1), dvec3(0, 1, 0));
  const ivec2 size(600, 400);
  const gl::Scissor rectangle{420, 60, 90, 200};
  const ReflectedCone cone = makePictureCone(clip, eye, size, rectangle);
  std::mt19937 random(6);
  int inside = 0;
  for (int i = 0; i < 40000; ++i) {
    const dvec3 point = eye + 7.0 * randomDirection(random);
    const dvec4 at = clip * dvec4(point, 1);
    const dvec2 px = (dvec2(at) / at.w + 1.0) * 0.5 * dvec2(size) - dvec2(rectangle.x, rectangle.y);
    const dvec2 outside = glm::max(-px, px - dvec2(rectangle.width, rectangle.height));
    const double far = std::max(outside.x, outside.y);
    if (at.w > 0 && far < 0) {
      EXPECT_TRUE(cone.mayMeet(point, 0));
      ++inside;
    }
    if (at.w < 0 || far > 2) {
      EXPECT_FALSE(cone.mayMeet(point, 0));
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(TriangleRuns, LeaveOutOnlyWhatNoRayMeets) {
  const ReflectorMesh mesh = meshOf(makeCap(2, 0.4, 1));
  const ReflectedCone cone = VirtualObjectSolver(mesh, dvec3(0.5, 0.2, 4), 20).reflectedCone();
  const geometry::Mesh floor = geometry::makePlane(30, 30, 60, 60);
  const TriangleRuns runs(floor.positions, floor.indices);
  std::vector<std::uint8_t> mayMeet;
  const std::size_t leftOut = runs.mark(cone, dmat4(1.0), mayMeet);
  ASSERT_EQ(mayMeet.size(), floor.indices.size() / 3);
  EXPECT_EQ(std::size_t(std::count(mayMeet.begin(), mayMeet.end(), 0)), leftOut);
  EXPECT_GT(leftOut, mayMeet.size() / 3);
  std::size_t met = 0;
  for (std::size_t i = 0; i < floor.indices.size(); ++i) {
    if (!cone.mayMeet(dvec3(floor.positions[floor.indices[i]]), 0)) continue;
    EXPECT_EQ(mayMeet[i / 3], 1) << i;
    ++met;
  }
  EXPECT_GT(met, 50u);
  // Seen through a flat mirror in y = 5.
  const dmat4 mirrored = glm::translate(dmat4(1), dvec3(0, 10, 0)) * glm::scale(dmat4(1), dvec3(1, -1, 1));
  std::vector<std::uint8_t> mayMeetMirrored;
  runs.mark(cone, mirrored, mayMeetMirrored);
  EXPECT_NE(mayMeetMirrored, mayMeet);
  for (std::size_t i = 0; i < floor.indices.size(); ++i)
    if (cone.mayMeet(dvec3(mirrored * dvec4(dvec3(floor.positions[floor.indices[i]]), 1)), 0)) {
      EXPECT_EQ(mayMeetMirrored[i / 3], 1) << i;
    }
}

TEST(ReflectedCone, ABallReflectsAllButItsShadow) {
  const Counts ball = countLost(meshOf(geometry::makeIcosphere(0.5, 12)), dvec3(0, 0, 3), 1);
  EXPECT_EQ(ball.lost, 0);
  EXPECT_LT(ball.culled, 100);
}

TEST(VertexRuns, BallsHoldTheTrianglesThatTouchThem) {
  test::TestWorld world(makeCap(2, 0.4, 1));
  world.add(geometry::makeQuad({-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}), true);
  const raster::TessellatedObjects objects = raster::tessellateForReflector(world.geometry(), 0);
  constexpr std::size_t kLength = 64;
  const VertexRuns runs(objects, kLength);
  ASSERT_GT(runs.balls().size(), 4u);
  double radii = 0;
  for (std::size_t i = 0; i < objects.indices.size(); ++i) {
    const Ball& ball = runs.balls()[objects.indices[i] / kLength];
    for (std::size_t k = 0; k < 3; ++k) {
      const dvec3 corner(objects.positions[objects.indices[i - i % 3 + k]]);
      EXPECT_LE(glm::length(corner - ball.centre), ball.radius * 1.000001);
    }
  }
  for (const Ball& ball : runs.balls()) radii += ball.radius;
  EXPECT_LT(radii / double(runs.balls().size()),
            4);  // of 12.7 for all: neighbours in the array are neighbours in space
}

TEST(ReflectedCone, MeetsBallsAsAnglesSay) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> half(0.0, 3.3), size(0.0, 1.5), far(0.1, 6.0);
  int met = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const ReflectedCone cone{
        randomDirection(random), size(random), randomDirection(random), half(random), {}};
    const double radius = size(random), both = cone.radius + radius;
    const dvec3 offset = far(random) * randomDirection(random);
    const double distance = glm::length(offset);
    const double angle = std::acos(std::clamp(glm::dot(offset, cone.axis) / distance, -1.0, 1.0));
    const double reach = cone.halfAngleRadians + (distance > both ? std::asin(both / distance) : 4.0);
    if (std::abs(angle - reach) < 1e-9) continue;
    EXPECT_EQ(cone.mayMeet(cone.centre + offset, radius), angle <= reach) << i;
    (angle <= reach ? met : missed)++;
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 500);
}

TEST(VertexRuns, CountsWhatIsLeftOut) {
  raster::TessellatedObjects objects;
  objects.positions.resize(25);
  const VertexRuns runs(objects, 10);
  EXPECT_EQ(runs.countLeftOut({}), 0u);
  EXPECT_EQ(runs.countLeftOut(std::vector<std::uint8_t>{1, 0, 0}), 15u);
}

TEST(VertexRuns, LeftOutRunsChangeNoOther) {
  const ReflectorMesh mesh = meshOf(makeCap(2, 0.4, 1));
  const VirtualObjectSolver solver(mesh, dvec3(0.5, 0.2, 4), 20);
  std::mt19937 random(5);
  constexpr std::size_t kRun = VertexRuns::kLength;
  std::vector<vec3> points(3 * kRun + kRun / 2 + 1);
  for (vec3& p : points) p = vec3(mesh.centre() + 5.0 * randomDirection(random));
  std::vector<vec3> all(points.size()), some(points.size());
  std::vector<VertexKind> allKinds(points.size()), someKinds(points.size());
  solver.compute(Solver::Refined, points, all, allKinds);
  const std::vector<std::uint8_t> mayReflect{1, 0, 1, 0};
  solver.compute(Solver::Refined, points, some, someKinds, {}, mayReflect);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool isIn = mayReflect[i / kRun] != 0;
    EXPECT_EQ(someKinds[i], isIn ? allKinds[i] : VertexKind::None);
    if (isIn) {
      EXPECT_EQ(some[i], all[i]);
    }
  }
}

TEST(Tessellation, SizeFollowsTheMirrorOnTheScreen) {
  scene::Reflector mirror;
  mirror.radius = 0.5;
  scene::CameraFrame camera;
  camera.heightPx = 1000;
  camera.tanHalfFovY = 0.5;  // 1000 pixels a radian: diameter 1000 / distance
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 100}, camera), 43.75);
  EXPECT_NEAR(raster::findTessellationSize(mirror, {0, 0, 4.5}, camera), 247.487, 1e-3);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 3}, camera), 350);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 0.8}, camera), 1400);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 0}, camera), 2800);
}

}  // namespace
}  // namespace catoptric::virtual_object
