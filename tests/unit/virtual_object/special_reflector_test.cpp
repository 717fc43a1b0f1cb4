// SPDX-License-Identifier: Apache-2.0
// Closed forms: the mirror law. (Every reflection there is: all_roots_test.cpp.) CATOPTRIC_PAIRS=1000000
// tries that many pairs of eye and point on each shape and side instead of a few thousand.
#include "catoptric/virtual_object/special_reflector.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "special_cases.h"

namespace catoptric::virtual_object {
namespace {

int pairCount() {
  const char* text = std::getenv("CATOPTRIC_PAIRS");
  return text ? std::max(1, std::atoi(text)) : 5000;
}

/// Distance from the surface, and the surface's outward normal.
struct Surface {
  double distance;
  dvec3 normal;
};

Surface surfaceAt(const SpecialReflector& s, const dvec3& p) {
  const dvec3 d = p - s.origin, across = d - s.axis * glm::dot(s.axis, d);
  switch (s.shape) {
    case SpecialShape::Plane:
      return {glm::dot(d, s.axis), s.axis};
    case SpecialShape::Sphere:
      return {glm::length(d) - s.radius, glm::normalize(d)};
    case SpecialShape::Cylinder:
      return {glm::length(across) - s.radius, glm::normalize(across)};
    case SpecialShape::Cone:
      break;
  }
  const double sine = std::sin(s.halfAngleRadians), cosine = std::cos(s.halfAngleRadians);
  return {glm::length(across) * cosine - glm::dot(d, s.axis) * sine,
          glm::normalize(across) * cosine - s.axis * sine};
}

class Special : public testing::TestWithParam<Side> {};

TEST_P(Special, EveryAnswerObeysTheMirrorLawOnTheSurface) {
  const SpecialReflector shape = makeShape(GetParam());
  std::mt19937 random(11);
  double worst = 0;
  std::size_t answers = 0;
  for (int i = 0; i < pairCount(); ++i) {
    const dvec3 eye = randomPoint(random, shape.origin), point = randomPoint(random, shape.origin);
    for (const Reflection& r : findReflections(shape, eye, point)) {
      ++answers;
      // Within a millionth of the surface a point has no direction worth the name.
      if (std::min(glm::distance(r.position, eye), glm::distance(r.position, point)) < 1e-6) continue;
      worst = std::max(worst, sineAt(r, eye, point));
      const Surface at = surfaceAt(shape, r.position);
      ASSERT_NEAR(at.distance, 0, 1e-9 * (1 + glm::length(r.position)));
      ASSERT_NEAR(glm::dot(at.normal, r.normal), shape.isInside ? -1 : 1, 1e-9);
      ASSERT_GT(glm::dot(r.normal, eye - r.position), 0);
      ASSERT_GT(glm::dot(r.normal, point - r.position), 0);
    }
  }
  EXPECT_LE(worst, 1e-9);
  EXPECT_GT(answers, std::size_t(pairCount()) / 10);
}

TEST_P(Special, DegenerateInputStaysFinite) {
  const SpecialReflector shape = makeShape(GetParam());
  const dvec3 on = shape.origin + 0.7 * shape.axis, off(5, 4, 3);
  for (const dvec3& eye : {shape.origin, on, off})
    for (const dvec3& point : {shape.origin, on, off, off + 3.0 * (off - shape.origin)})
      for (const Reflection& r : findReflections(shape, eye, point))
        EXPECT_TRUE(std::isfinite(glm::length(r.position + r.normal)));
}

INSTANTIATE_TEST_SUITE_P(Shapes, Special,
                         testing::Values(Side{SpecialShape::Plane, false}, Side{SpecialShape::Sphere, false},
                                         Side{SpecialShape::Sphere, true},
                                         Side{SpecialShape::Cylinder, false},
                                         Side{SpecialShape::Cylinder, true}, Side{SpecialShape::Cone, false},
                                         Side{SpecialShape::Cone, true}));

TEST(Special, OutsideASphereThereIsOneWhereItIsNotInTheShadow) {
  const SpecialReflector sphere{SpecialShape::Sphere, dvec3(0), {0, 0, 1}, 1, 0, false};
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 eye = randomDirection(random) * 3.0, point = randomDirection(random) * 2.0, d = point - eye;
    const double t = std::clamp(-glm::dot(eye, d) / glm::dot(d, d), 0.0, 1.0);
    const double clearance = glm::length(eye + t * d) - 1;
    if (std::abs(clearance) < 1e-6) continue;
    EXPECT_EQ(findReflections(sphere, eye, point).count, clearance > 0 ? 1 : 0);
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
