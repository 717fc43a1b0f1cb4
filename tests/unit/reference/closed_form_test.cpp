// SPDX-License-Identifier: Apache-2.0
// The ray tracer against mirrors whose reflections are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "catoptric/reference/ray_differential.h"
#include "traced_scene.h"

namespace catoptric::reference {
namespace {

struct AnalyticHit {
  dvec3 mirrorPoint, direction, normal;
};

/// First hit of a ray with the unit sphere at the origin, and the mirrored direction.
std::optional<AnalyticHit> reflectInUnitSphere(const dvec3& eye, const dvec3& direction) {
  const double b = glm::dot(eye, direction), c = glm::dot(eye, eye) - 1, discriminant = b * b - c;
  if (discriminant <= 0) return std::nullopt;
  const dvec3 point = eye - direction * (b + std::sqrt(discriminant));
  return AnalyticHit{point, core::reflectDirection(direction, point), point};
}

/// Mirror ball over a large unlit floor at y = -1.5, and a far unlit sphere of radius 10 around it all.
TracedTestScene makeBallOverFloor(int slices, const vec3& tint = vec3(1)) {
  TracedTestScene t;
  t.add(makeBall(slices, slices / 2), makeMirror(tint), "ball");
  t.add(makeQuad({-50, -1.5f, 50}, {100, 0, 0}, {0, 0, -100}), makeUnlit({0.25f, 0.5f, 0.75f}), "floor");
  t.camera.eye = {0.3, 1.0, 4};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.6;
  t.finish();
  return t;
}

/// Largest distance, relative to the distance flown after the mirror, of seen points from where the analytic
/// ray meets the floor. Rays that meet the ball at a steeper angle than 60 degrees only, so that tessellation
/// is the error.
double largestFloorError(int slices, int* compared) {
  const TracedTestScene t = makeBallOverFloor(slices);
  const TraceResult result = t.trace(64, 64);
  const scene::CameraFrame frame = t.frame(64, 64);
  double largest = 0;
  *compared = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const core::SeenPixel& seen = result.seen.at(x, y);
      const dvec3 d = glm::normalize(frame.rayDirection(x + 0.5, y + 0.5));
      const auto hit = reflectInUnitSphere(frame.eye, d);
      if (!hit || glm::dot(-d, hit->normal) < 0.5 || hit->direction.y > -0.2) continue;
      const double flight = (-1.5 - hit->mirrorPoint.y) / hit->direction.y;
      const dvec3 expected = hit->mirrorPoint + flight * hit->direction;
      EXPECT_TRUE(seen.isMirror());
      EXPECT_EQ(seen.bounces, 1u);
      EXPECT_EQ(seen.object, 1u);
      largest = std::max(largest, glm::length(dvec3(seen.point) - expected) / flight);
      ++*compared;
    }
  return largest;
}

TEST(ClosedForm, BallOverFloorConvergesWithTheSquareOfTheTessellation) {
  int compared = 0;
  const double coarse = largestFloorError(64, &compared), fine = largestFloorError(256, &compared),
               finest = largestFloorError(512, &compared);
  EXPECT_GT(compared, 100);
  EXPECT_LT(finest, 1e-3);
  EXPECT_LT(fine, coarse / 8);    // 16 in theory
  EXPECT_LT(finest, fine / 2.5);  // 4 in theory
}

TEST(ClosedForm, BallInsideBall) {
  TracedTestScene t;
  t.add(makeBall(512, 256), makeMirror(), "ball");
  scene::Material room = makeUnlit({0.5f, 0.5f, 0.5f});
  room.doubleSided = true;
  t.add(makeBall(512, 256), room, "room", glm::scale(dmat4(1), dvec3(10)));
  t.camera.eye = {0, 0.5, 5};
  t.finish();
  const TraceResult result = t.trace(48, 48);
  const scene::CameraFrame frame = t.frame(48, 48);
  int compared = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const dvec3 d = glm::normalize(frame.rayDirection(x + 0.5, y + 0.5));
      const auto hit = reflectInUnitSphere(frame.eye, d);
      if (!hit || glm::dot(-d, hit->normal) < 0.4) continue;
      const double b = glm::dot(hit->mirrorPoint, hit->direction);
      const double flight = -b + std::sqrt(b * b + 99);
      const dvec3 expected = hit->mirrorPoint + flight * hit->direction;
      EXPECT_LT(glm::length(dvec3(result.seen.at(x, y).point) - expected), 0.01);
      EXPECT_NEAR(result.seen.at(x, y).pathLength, glm::length(hit->mirrorPoint - frame.eye) + flight, 0.005);
      ++compared;
    }
  EXPECT_GT(compared, 200);
}

TEST(ClosedForm, MirrorLawHoldsAtTheSeenMirrorPoint) {
  const TracedTestScene t = makeBallOverFloor(512);
  const core::SeenImage mirror = t.trace(64, 64, {.bounces = 0}).seen, seen = t.trace(64, 64).seen;
  const dvec3 eye = t.camera.eye;
  int compared = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const core::SeenPixel &j = mirror.data()[i], &q = seen.data()[i];
    if (!q.isMirror()) continue;
    const dvec3 point(j.point), toEye = glm::normalize(eye - point);
    if (glm::dot(toEye, point) < 0.3) continue;
    const dvec3 toSeen = q.isSky() ? dvec3(q.point) : glm::normalize(dvec3(q.point) - point);
    const dvec3 normal = glm::normalize(point);  // of the smooth ball
    EXPECT_LT(glm::length(glm::cross(glm::normalize(toEye + toSeen), normal)), 1e-3);
    if (!q.isSky()) {
      EXPECT_NEAR(q.pathLength, glm::length(eye - point) + glm::length(dvec3(q.point) - point), 1e-4);
    }
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

/// The ray of `hit` after the unit sphere, made of glass: refracted where it enters and where it leaves.
AnalyticHit refractThroughUnitSphere(const dvec3& point, const dvec3& direction, double ior) {
  const dvec3 inside = *core::findRefractedDirection(direction, point, 1 / ior);
  const dvec3 exit = point - 2 * glm::dot(inside, point) * inside;
  return {exit, *core::findRefractedDirection(inside, -exit, ior), exit};
}

/// Largest distance, relative to the flight, of what is seen on the floor through a ball of glass of
/// index 1.5 from where rays through a ball of index `ior` meet it.
double largestErrorThroughGlass(double ior, int* compared) {
  TracedTestScene t = makeBallOverFloor(512);
  scene::Material& glass = t.scene.materials.front();
  glass.metallic = 0;
  glass.transmission = glass.thickness = 1;
  t.finish();
  EXPECT_TRUE(t.world.reflectors.at(0).isRefractor());
  const TraceResult result = t.trace(64, 64);
  const scene::CameraFrame frame = t.frame(64, 64);
  double largest = 0;
  *compared = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const core::SeenPixel& seen = result.seen.at(x, y);
      const dvec3 d = glm::normalize(frame.rayDirection(x + 0.5, y + 0.5));
      const auto entry = reflectInUnitSphere(frame.eye, d);
      if (!entry || glm::dot(-d, entry->normal) < 0.5) continue;
      const AnalyticHit exit = refractThroughUnitSphere(entry->mirrorPoint, d, ior);
      if (exit.direction.y > -0.2) continue;
      const double flight = (-1.5 - exit.mirrorPoint.y) / exit.direction.y;
      const dvec3 expected = exit.mirrorPoint + flight * exit.direction;
      EXPECT_EQ(seen.bounces, 2u);
      largest = std::max(largest, glm::length(dvec3(seen.point) - expected) / flight);
      ++*compared;
    }
  return largest;
}

TEST(ClosedForm, BallOfGlass) {
  int compared = 0;
  EXPECT_LT(largestErrorThroughGlass(1.5, &compared), 2e-3);
  EXPECT_GT(compared, 100);
  EXPECT_GT(largestErrorThroughGlass(1.52, &compared), 1e-2) << "the twin: another glass";
}

TEST(ClosedForm, ChangeOfTheRefractedDirection) {
  const double step = 1e-6;
  for (const double eta : {1 / 1.5, 1.5}) {
    const dvec3 direction = glm::normalize(dvec3(0.3, -0.2, -1)), normal = glm::normalize(dvec3(0.1, 0.2, 1));
    const dvec3 directionChange(0.4, -0.3, 0.1), normalChange(-0.2, 0.5, 0.05);
    const auto along = [](const dvec3& unit, const dvec3& change) {
      return change - unit * glm::dot(unit, change);
    };
    const dvec3 d = along(direction, directionChange), n = along(normal, normalChange);
    const dvec3 here = *core::findRefractedDirection(direction, normal, eta);
    const dvec3 there = *core::findRefractedDirection(glm::normalize(direction + step * d),
                                                      glm::normalize(normal + step * n), eta);
    EXPECT_LT(glm::length((there - here) / step - refractDerivative(direction, d, normal, n, eta)), 1e-5);
  }
}

TEST(ClosedForm, GlassDarkensWithTheWayInside) {
  TracedTestScene t;
  scene::Material glass;
  glass.metallic = glass.roughness = 0;
  glass.transmission = glass.thickness = 1;
  glass.ior = 1;  // nothing is bent or sent back: the way inside is all there is
  glass.attenuationColor = {0.5f, 0.25f, 1};
  glass.attenuationDistance = 2;
  t.add(makeBall(512, 256), glass, "ball");
  t.add(makeQuad({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), makeUnlit(vec3(1)), "wall");
  t.camera.eye = {0, 0, 5};
  t.camera.target = {0, 0, 0};
  t.finish();
  const auto radiance = t.trace(33, 33, {}).radiance;
  const vec4 centre = radiance.at(16, 16), corner = radiance.at(0, 0);
  EXPECT_NEAR(centre.x, 0.5, 0.001);
  EXPECT_NEAR(centre.y, 0.25, 0.001);
  EXPECT_NEAR(centre.z, 1, 0.001);
  EXPECT_EQ(vec3(corner), vec3(1));
}

/// Things in front of a mirror in the plane z = 0, with and without the mirror.
TracedTestScene makeRoom(bool withMirror) {
  TracedTestScene t;
  t.scene.textures.push_back(makeChecker(8, 8));
  scene::Material floor;
  floor.metallic = 0;
  floor.baseColorTexture.texture = 0;
  t.add(makeQuad({-6, -1, 12}, {12, 0, 0}, {0, 0, -12}, 4), floor, "floor");
  scene::Material paint;
  paint.metallic = 0;
  paint.roughness = 0.4f;
  paint.baseColor = {0.8f, 0.2f, 0.1f, 1};
  t.add(makeBall(40, 20), paint, "ball", glm::translate(dmat4(1), dvec3(0.7, 0, 2)));
  scene::Light light;
  light.position = {1, 4, 5};
  light.color = vec3(40);
  t.scene.lights.push_back(light);
  if (withMirror) t.add(makeQuad({-3, -1, 0}, {6, 0, 0}, {0, 4, 0}), makeMirror(), "mirror");
  t.camera.eye = {-1, 1, 6};
  t.camera.target = {0, 0.3, 0};
  t.finish();
  return t;
}

TEST(ClosedForm, PlanarMirrorShowsTheMirroredScene) {
  const TracedTestScene mirrored = makeRoom(true), direct = makeRoom(false);
  const TraceResult a = mirrored.trace(96, 72);
  scene::CameraFrame frame = mirrored.frame(96, 72);
  const core::Plane plane{{0, 0, 1}, 0};
  frame.eye = core::reflectPoint(frame.eye, plane);
  for (dvec3* axis : {&frame.right, &frame.up, &frame.forward})
    *axis = core::reflectDirection(*axis, plane.normal);
  const TraceResult b = direct.tracer->trace(frame, {});
  int compared = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const core::SeenPixel &p = a.seen.at(x, y), &q = b.seen.at(x, y);
      if (!p.isMirror()) continue;
      ++compared;
      ASSERT_EQ(p.object, q.object) << x << " " << y;
      EXPECT_LT(glm::length(p.point - q.point), 2e-5f * std::max(1.0f, glm::length(q.point)));
      if (!p.isSky()) {
        EXPECT_NEAR(p.pathLength, q.pathLength, 1e-4);
      }
      const vec3 difference = glm::abs(vec3(a.radiance.at(x, y)) - vec3(b.radiance.at(x, y)));
      EXPECT_LT(std::max({difference.x, difference.y, difference.z}), 2e-4f) << x << " " << y;
      const core::Footprint &f = a.footprints.at(x, y), &g = b.footprints.at(x, y);
      EXPECT_LT(glm::length(f.dPdx - g.dPdx), 1e-3f * (1e-4f + glm::length(g.dPdx)));
      EXPECT_LT(glm::length(f.dPdy - g.dPdy), 1e-3f * (1e-4f + glm::length(g.dPdy)));
    }
  EXPECT_GT(compared, 1500);
}

TEST(ClosedForm, FootprintsAreTheDifferencesOfNeighbours) {
  // On the floor seen directly and in the ball; the finite difference over two pixels is the judge.
  const TracedTestScene t = makeBallOverFloor(512);
  const TraceResult result = t.trace(256, 256);
  int compared = 0;
  for (int y = 1; y < 255; ++y)
    for (int x = 1; x < 255; ++x) {
      const auto same = [&](int i, int j) {
        const core::SeenPixel &p = result.seen.at(i, j), &q = result.seen.at(x, y);
        return p.object == 1u && q.object == 1u && p.bounces == q.bounces;
      };
      if (!same(x - 1, y) || !same(x + 1, y) || !same(x, y - 1) || !same(x, y + 1)) continue;
      const vec3 dx = 0.5f * (result.seen.at(x + 1, y).point - result.seen.at(x - 1, y).point);
      const vec3 dy = 0.5f * (result.seen.at(x, y + 1).point - result.seen.at(x, y - 1).point);
      if (glm::length(dx) > 0.1f || glm::length(dy) > 0.1f)
        continue;  // grazing: the difference is no derivative
      const core::Footprint& f = result.footprints.at(x, y);
      EXPECT_LT(glm::length(f.dPdx - dx), 0.06f * glm::length(dx)) << x << " " << y;
      EXPECT_LT(glm::length(f.dPdy - dy), 0.06f * glm::length(dy)) << x << " " << y;
      ++compared;
    }
  EXPECT_GT(compared, 5000);
}

}  // namespace
}  // namespace catoptric::reference
