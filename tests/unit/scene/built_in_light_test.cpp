// SPDX-License-Identifier: Apache-2.0
// Baked light against closed forms and brute force, and textures that must repeat.
#include <gtest/gtest.h>

#include <cmath>

#include "catoptric/geometry/mesh_inspection.h"
#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/noise.h"
#include "catoptric/scene/built_in/textures.h"
#include "catoptric/scene/built_in/vehicles.h"

namespace catoptric::scene::built_in {
namespace {

/// Cosine-weighted share of the hemisphere over `point` that a box from lower to upper leaves open, by many
/// rays.
double countOpenness(const dvec3& point, const dvec3& lower, const dvec3& upper) {
  constexpr int kSide = 200;
  int open = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double radius = std::sqrt((i + 0.5) / kSide), angle = 2 * 3.141592653589793 * (j + 0.5) / kSide;
      const dvec3 d(radius * std::cos(angle), std::sqrt(1 - radius * radius), radius * std::sin(angle));
      double enter = 0, leave = 1e9;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (lower[axis] - point[axis]) / d[axis], b = (upper[axis] - point[axis]) / d[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      open += enter < leave ? 0 : 1;
    }
  return double(open) / (kSide * kSide);
}

TEST(BakedLight, BoxCoversWhatRaysFind) {
  BakedLight light;
  light.addBox({0, 0.5, 0}, {1, 1, 2});
  for (const dvec3& p : {dvec3(0.6, 0, 0), dvec3(0.9, 0, 0.7), dvec3(-0.7, 0, -1.4), dvec3(2, 0, 1)})
    EXPECT_NEAR(light.openness(p), countOpenness(p, {-0.5, 0, -1}, {0.5, 1, 1}), 0.01);
}

TEST(BakedLight, FloatingBoxAndBallOverThePoint) {
  BakedLight box;
  box.addBox({0, 1.0, 0}, {1, 0.2, 1});
  EXPECT_NEAR(box.openness({0.2, 0, 0.1}), countOpenness({0.2, 0, 0.1}, {-0.5, 0.9, -0.5}, {0.5, 1.1, 0.5}),
              0.01);
  BakedLight ball;
  ball.addBall({0, 2, 0}, 1);
  EXPECT_NEAR(ball.openness({0, 0, 0}), 1 - 0.25, 1e-9);  // (r / d)^2
}

TEST(BakedLight, UnderABoxIsDarkAndFarAwayIsOpen) {
  BakedLight light;
  light.addBox({0, 0.5, 0}, {1, 1, 1});
  EXPECT_EQ(light.openness({0.1, 0, 0.2}), 0);
  EXPECT_EQ(light.openness({100, 0, 0}), 1);
}

TEST(BakedLight, LampIsHiddenInTheShadowOnly) {
  BakedLight light;
  light.addBox({0, 0.5, 0}, {1, 1, 1});
  light.setLamp({-4, 4, 0}, 0.1);
  EXPECT_EQ(light.lampShare({0.9, 0, 0}), 0);
  EXPECT_EQ(light.lampShare({-1.5, 0, 0}), 1);
  EXPECT_EQ(light.lampShare({3.0, 0, 0}), 1);
  EXPECT_EQ(light.lampShare({0.9, 0, 2}), 1);
}

TEST(Textures, RepeatWithoutASeam) {
  const vec3 a(0.2f), b(0.7f);
  const std::pair<const char*, Pattern> patterns[] = {
      {"planks", woodPlanks(a, b, 4, 3)}, {"bricks", bricks(a, b, 4, 8, 2)}, {"tiles", tiles(a, b, 4, 3)},
      {"plaster", plaster(a, 0.1, 3)},    {"speckle", speckle(a, b, 32, 4)}, {"grass", grass(5)}};
  for (const auto& [name, pattern] : patterns)
    for (double t : {0.11, 0.37, 0.83}) {
      constexpr double e = 1e-6;
      EXPECT_LT(glm::distance(pattern({e, t}), pattern({1 - e, t})), 0.02f) << name << " u " << t;
      if (std::string(name) == "planks") continue;  // boards of another row meet at v = 0, with a joint
      EXPECT_LT(glm::distance(pattern({t, e}), pattern({t, 1 - e})), 0.02f) << name << " v " << t;
    }
}

TEST(Textures, NoiseIsPeriodicAndInRange) {
  for (int i = 0; i < 200; ++i) {
    const dvec2 p(0.37 * i, 0.61 * i);
    const double value = fractalNoise(p, {5, 7}, 4, 9);
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1);
    EXPECT_NEAR(value, fractalNoise(p + dvec2(5, -7), {5, 7}, 4, 9), 1e-9);
  }
}

TEST(Textures, OctavesSideBySideAreThoseOneByOneToTheBit) {
  const ivec2 period(6, 3);
  for (int i = -300; i < 300; ++i) {
    const dvec2 p(0.0373 * i, 0.0617 * i);
    double sum = 0, weight = 0, strength = 1;
    for (int octave = 0; octave < 6; ++octave) {
      sum += strength * periodicNoise(p * double(1 << octave), period * (1 << octave), 9 + 101 * octave);
      weight += strength;
      strength *= 0.5;
    }
    EXPECT_EQ(fractalNoise(p, period, 6, 9), sum / weight) << i;
  }
}

TEST(WingMirror, IsSphericalInsideAndBendsMoreOutside) {
  WingMirrorOptions options;
  options.isOuterLeft = true;
  const geometry::Mesh glass = makeWingMirrorGlass(options);
  EXPECT_EQ(geometry::findDeepestConcavity(glass, 1e-9), 0);
  const double radius = options.radiusOfCurvature;
  double farthestOuter = 0;
  for (std::size_t i = 0; i < glass.positions.size(); ++i) {
    const dvec3 p = glass.positions[i], n = glass.normals[i];
    const dvec3 sphereNormal = (p + dvec3(0, 0, radius)) / radius;
    if (p.x > 0)
      ASSERT_LT(glm::distance(n, sphereNormal), 1e-6);
    else
      farthestOuter =
          std::max(farthestOuter, std::acos(std::min(1.0, glm::dot(n, glm::normalize(sphereNormal)))));
  }
  EXPECT_GT(farthestOuter, glm::radians(2.0));
}

}  // namespace
}  // namespace catoptric::scene::built_in
