// SPDX-License-Identifier: Apache-2.0
// Reflections drawn through virtual triangles against ray-traced truth, on the CPU, for the kinds of mirrors
// that the product is about. Limits are about twice the measured error.
#include <gtest/gtest.h>

#include <cstdio>

#include "catoptric/geometry/shapes.h"
#include "reflection_harness.h"

namespace catoptric::virtual_object::test {
namespace {

using geometry::Mesh;

Mesh boxAt(const dvec3& size, const dvec3& centre) {
  return geometry::transformed(geometry::makeBox(size), geometry::moveBy(centre));
}

void addRoom(TestWorld& world, double halfSize, double height) {
  const double h = halfSize;
  world.add(geometry::makeQuad({-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h}), true);
  world.add(geometry::makeQuad({-h, height, -h}, {h, height, -h}, {h, height, h}, {-h, height, h}), true);
  world.add(geometry::makeQuad({-h, 0, -h}, {h, 0, -h}, {h, height, -h}, {-h, height, -h}), true);
  world.add(geometry::makeQuad({h, 0, h}, {-h, 0, h}, {-h, height, h}, {h, height, h}), true);
  world.add(geometry::makeQuad({-h, 0, h}, {-h, 0, -h}, {-h, height, -h}, {-h, height, h}), true);
  world.add(geometry::makeQuad({h, 0, -h}, {h, 0, h}, {h, height, h}, {h, height, -h}), true);
}

scene::CameraFrame cameraAt(const dvec3& eye, const dvec3& target, double fovYRadians, int width = 960,
                            int height = 720) {
  scene::Camera camera;
  camera.eye = eye, camera.target = target, camera.fovYRadians = fovYRadians;
  return scene::makeCameraFrame(camera, width, height);
}

/// A patch of a surface z = height(x, y) around the origin, seen from +z, with exact normals.
template <class Height>
Mesh makePatch(double width, double heightY, int cellsX, int cellsY, const Height& f) {
  Mesh mesh;
  for (int j = 0; j <= cellsY; ++j)
    for (int i = 0; i <= cellsX; ++i) {
      const double x = width * (double(i) / cellsX - 0.5), y = heightY * (double(j) / cellsY - 0.5), e = 1e-5;
      mesh.positions.push_back(vec3(x, y, f(x, y)));
      mesh.normals.push_back(vec3(glm::normalize(
          dvec3(-(f(x + e, y) - f(x - e, y)) / (2 * e), -(f(x, y + e) - f(x, y - e)) / (2 * e), 1))));
    }
  for (std::uint32_t j = 0; j < std::uint32_t(cellsY); ++j)
    for (std::uint32_t i = 0; i < std::uint32_t(cellsX); ++i) {
      const std::uint32_t a = j * (cellsX + 1) + i, b = a + 1, c = b + cellsX + 1, d = a + cellsX + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  return mesh;
}

struct Limits {
  double medianPx, within1, lost, objectsWithin1, objectsLost;
};

HarnessResult report(const HarnessResult& r, const std::string& name) {
  std::printf(
      "%-20s %6zu tri %6zu vert %6zu drawn %5.1f ms | mirror %zu px: median %.3f p95 %.3f <=1 %.4f lost %.4f "
      "| "
      "objects %zu px: median %.3f p95 %.3f <=1 %.4f lost %.4f\n",
      name.c_str(), r.triangles, r.vertices, r.drawn, r.solveSeconds * 1e3, r.mirror.pixels,
      r.mirror.medianPx, r.mirror.p95Px, r.mirror.within1, r.mirror.lost, r.objects.pixels,
      r.objects.medianPx, r.objects.p95Px, r.objects.within1, r.objects.lost);
  return r;
}

bool isWithin(const HarnessResult& r, const Limits& limits) {
  return r.mirror.medianPx <= limits.medianPx && r.objects.medianPx <= limits.medianPx &&
         r.mirror.within1 >= limits.within1 && r.mirror.lost <= limits.lost &&
         r.objects.within1 >= limits.objectsWithin1 && r.objects.lost <= limits.objectsLost;
}

void expectWithin(const TestWorld& world, const scene::CameraFrame& camera, const std::string& name,
                  const Limits& limits) {
  const HarnessResult r = report(measureReflection(world, camera, Solver::Refined, {}, name), name);
  EXPECT_GT(r.mirror.pixels, 10000u);
  EXPECT_GT(r.objects.pixels, 1000u);
  EXPECT_TRUE(isWithin(r, limits));
}

// What is lost are strips one pixel wide at the rim, whose footprint the harness cannot measure.
constexpr Limits kLimits{0.15, 0.99, 0.004, 0.985, 0.008};

TestWorld makeSphereWorld() {
  TestWorld world(geometry::transformed(geometry::makeIcosphere(0.5, 24), geometry::moveBy({0, 0.5, 0})),
                  scene::ReflectorShape::Sphere);
  addRoom(world, 4, 3);
  world.add(boxAt({0.3, 0.3, 0.3}, {0.7, 0.15, 0.4}), false);
  world.add(boxAt({0.2, 0.8, 0.2}, {-0.62, 0.4, 0.2}), false);  // 20 mm from the sphere
  world.add(boxAt({0.15, 0.15, 0.15}, {0.1, 0.075, 0.55}), false);
  world.add(boxAt({0.5, 1.2, 0.5}, {-1.6, 0.6, -1.2}), false);  // behind the sphere
  world.add(boxAt({0.4, 0.4, 0.4}, {1.5, 1.6, 1.5}), false);
  return world;
}

/// The sphere is 700 px wide.
scene::CameraFrame sphereCamera(int width = 960, int height = 720) {
  return cameraAt({0.4, 0.9, 2.6}, {0, 0.5, 0}, 0.385, width, height);
}

TEST(Picture, sphereInARoom) {
  expectWithin(makeSphereWorld(), sphereCamera(), "sphere", kLimits);
}

TEST(Picture, sphereSeenFromNear) {
  expectWithin(makeSphereWorld(), cameraAt({0.2, 1.1, 0.9}, {0, 0.5, 0}, 1.2), "sphere-near", kLimits);
}

TEST(Picture, cylinderSideStandingOnTheFloor) {
  Mesh side = geometry::transformed(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false),
                                    geometry::moveBy({0, 0.8, 0}));
  TestWorld world(side);
  addRoom(world, 4, 3);
  world.add(boxAt({0.3, 0.3, 0.3}, {0.55, 0.15, 0.3}), false);
  world.add(boxAt({0.2, 1.0, 0.2}, {-0.45, 0.5, 0.15}), false);
  world.add(boxAt({0.1, 0.1, 0.1}, {0.05, 0.05, 0.37}), false);
  world.add(boxAt({0.5, 1.2, 0.5}, {1.6, 0.6, 1.2}), false);
  expectWithin(world, cameraAt({0.5, 1.3, 2.4}, {0, 0.8, 0}, 0.75), "cylinder", kLimits);
}

TEST(Picture, wingMirror) {
  // Radius 1.3 m, 18 x 11 cm, eye at 0.7 m, a road behind the viewer: the view is along +z, the mirror looks
  // back.
  const double radius = 1.3;
  Mesh patch = makePatch(0.18, 0.11, 24, 16, [&](double x, double y) {
    return std::sqrt(radius * radius - x * x - y * y) - radius;
  });
  patch = geometry::transformed(std::move(patch),
                                geometry::moveBy({0, 1.0, 0}) * geometry::turnAround({0, 1, 0}, 0.35));
  TestWorld world(patch);
  world.add(geometry::makeQuad({-60, 0, 120}, {60, 0, 120}, {60, 0, -30}, {-60, 0, -30}), true);
  world.add(boxAt({1.8, 1.5, 4.2}, {-2.0, 0.75, 8}), false);
  world.add(boxAt({1.8, 1.5, 4.2}, {-3.0, 0.75, 25}), false);
  world.add(boxAt({1.8, 1.5, 4.2}, {0.5, 0.75, 14}), false);
  world.add(boxAt({2.5, 3.5, 9}, {-6.5, 1.75, 50}), false);
  world.add(boxAt({0.3, 1.2, 3.5}, {0.35, 0.6, 2.2}), false);  // flank of the own car
  for (int i = 0; i < 8; ++i) world.add(boxAt({0.15, 5, 0.15}, {-9, 2.5, 4.0 + 9 * i}), false);
  expectWithin(world, cameraAt({0.45, 1.1, 0.54}, {0, 1.0, 0}, 0.23), "wing-mirror", kLimits);
}

TEST(Picture, fenderPatch) {
  // Free-form, convex, open, no back faces; curvature from 0.3 to 2 m.
  Mesh patch = makePatch(1.2, 0.7, 48, 32, [](double x, double y) {
    return -0.35 * x * x - 0.25 * x * x * x * x - 0.9 * y * y - 0.12 * x * x * x - 0.2 * x * y -
           0.4 * y * y * y * y;
  });
  patch = geometry::transformed(std::move(patch),
                                geometry::moveBy({0, 0.8, 0}) * geometry::turnAround({1, 0, 0}, -0.5));
  TestWorld world(patch);
  addRoom(world, 4, 3);
  world.add(boxAt({0.2, 0.2, 0.2}, {0.3, 1.0, 0.35}), false);
  world.add(boxAt({0.1, 0.5, 0.1}, {-0.35, 1.1, 0.25}), false);
  world.add(boxAt({0.1, 0.1, 0.1}, {-0.1, 0.72, 0.22}), false);
  world.add(boxAt({0.6, 1.5, 0.4}, {1.5, 0.75, 1.6}), false);
  expectWithin(world, cameraAt({-0.3, 1.4, 1.6}, {0, 0.8, 0}, 0.6), "fender", kLimits);
}

TEST(Picture, findersOnTheSphere) {
  // Half the size, for time; layered measured 0.12 px median and 98.4 % within 1 px of object pixels.
  const TestWorld world = makeSphereWorld();
  const auto measure = [&](Solver solver, const char* name) {
    return report(measureReflection(world, sphereCamera(480, 360), solver, {}, name), name);
  };
  EXPECT_TRUE(isWithin(measure(Solver::Analytic, "analytic"), kLimits));
  EXPECT_TRUE(isWithin(measure(Solver::Subdivision, "subdivision"), kLimits));
  EXPECT_TRUE(isWithin(measure(Solver::Layered, "layered"), {0.15, 0.97, 0.02, 0.97, 0.02}));
}

TEST(Picture, aWrongNormalDoesNotPass) {
  // The twin that must fail: the solver works on normals turned by 0.3 degrees, the truth on the right ones.
  const TestWorld world = makeSphereWorld();
  scene::WorldGeometry wrong = world.geometry();
  const scene::Part& part = wrong.parts[0];
  for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v)
    wrong.normals[v] = glm::normalize(wrong.normals[v] + vec3(0, 0.005f, 0));
  const HarnessResult r =
      report(measureReflection(world, sphereCamera(480, 360), Solver::Refined, {}, "wrong-normal", &wrong),
             "wrong-normal");
  EXPECT_FALSE(isWithin(r, kLimits));
}

TEST(Picture, explosionAsPublishedIsWorseByFar) {
  const HarnessResult r =
      report(measureReflection(makeSphereWorld(), sphereCamera(240, 180), Solver::Explosion, {}, "explosion"),
             "explosion 240x180");
  EXPECT_GT(r.mirror.pixels, 20000u);
  EXPECT_GT(r.mirror.medianPx, 2.0);  // of a sphere 175 px wide; 17 where it is 700 px wide
}

TEST(Picture, aConcaveBowlStaysSane) {
  // Not what the method is made for yet: the wall lies near the bowl's focus. But the box before the focus is
  // exact.
  geometry::Mesh bowl =
      makePatch(1.0, 0.7, 32, 24, [](double x, double y) { return 0.25 * (x * x + y * y); });
  TestWorld world(geometry::transformed(std::move(bowl), geometry::moveBy({0, 1, 0})));
  addRoom(world, 4, 3);
  world.add(boxAt({0.2, 0.2, 0.2}, {0.2, 1.1, 0.4}), false);
  const HarnessResult r = report(measureReflection(world, cameraAt({0.2, 1.2, 1.5}, {0, 1, 0}, 0.6, 160, 120),
                                                   Solver::Refined, {}, "bowl"),
                                 "bowl 160x120");
  EXPECT_GT(r.objects.pixels, 500u);
  EXPECT_LE(r.objects.medianPx, 0.15);
  EXPECT_LE(r.objects.lost, 0.02);
}

}  // namespace
}  // namespace catoptric::virtual_object::test
