// SPDX-License-Identifier: Apache-2.0
// Closed forms: the mirror law, and every reflection there is. CATOPTRIC_PAIRS=1000000 tries that many pairs
// of eye and point on each shape and side instead of a few thousand.
#include "catoptric/virtual_object/special_reflector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>

#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

int pairCount() {
  const char* text = std::getenv("CATOPTRIC_PAIRS");
  return text ? std::max(1, std::atoi(text)) : 5000;
}

SpecialReflector makeShape(SpecialShape shape, bool isInside) {
  const dvec3 origin(0.3, -0.2, 0.5), axis = glm::normalize(dvec3(0.4, 1, -0.3));
  return {shape, origin, axis, 0.7, 0.45, isInside};
}

dvec3 randomPoint(std::mt19937& random, const dvec3& around) {
  std::uniform_real_distribution<double> uniform(0, 1);
  return around + randomDirection(random) * (0.05 + 6 * uniform(random) * uniform(random));
}

/// The sine of the angle between the half vector and the normal.
double residualOf(const Reflection& r, const dvec3& eye, const dvec3& point) {
  const dvec3 half = glm::normalize(eye - r.position) + glm::normalize(point - r.position);
  return glm::length(glm::cross(glm::normalize(half), r.normal));
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

struct Side {
  SpecialShape shape;
  bool isInside;
};

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest asks for this name.
void PrintTo(const Side& side, std::ostream* out) {
  constexpr const char* kNames[] = {"plane", "sphere", "cylinder", "cone"};
  *out << kNames[int(side.shape)] << (side.isInside ? " inside" : " outside");
}

class Special : public testing::TestWithParam<Side> {};

TEST_P(Special, EveryAnswerObeysTheMirrorLawOnTheSurface) {
  const SpecialReflector shape = makeShape(GetParam().shape, GetParam().isInside);
  std::mt19937 random(11);
  double worst = 0;
  std::size_t answers = 0;
  for (int i = 0; i < pairCount(); ++i) {
    const dvec3 eye = randomPoint(random, shape.origin), point = randomPoint(random, shape.origin);
    for (const Reflection& r : findReflections(shape, eye, point)) {
      ++answers;
      // Within a millionth of the surface a point has no direction worth the name.
      if (std::min(glm::distance(r.position, eye), glm::distance(r.position, point)) < 1e-6) continue;
      worst = std::max(worst, residualOf(r, eye, point));
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

/// Shortest path over the generator (or the point of the great circle) at angle phi, and its foot.
struct Path {
  double length;
  Reflection at;
};

using PathOver = std::function<Path(double phi)>;

PathOver makePathOver(const SpecialReflector& s, const dvec3& eye, const dvec3& point) {
  dvec3 x = glm::normalize(glm::cross(s.axis, dvec3(0.3, 0.1, 1))), y = glm::cross(s.axis, x);
  if (s.shape == SpecialShape::Sphere) {
    x = glm::normalize(eye - s.origin);
    y = glm::normalize(point - s.origin - x * glm::dot(x, point - s.origin));
  }
  return [=](double phi) {
    const dvec3 out = std::cos(phi) * x + std::sin(phi) * y;
    const double sign = s.isInside ? -1 : 1;
    if (s.shape == SpecialShape::Sphere) {
      const dvec3 j = s.origin + s.radius * out;
      return Path{glm::distance(eye, j) + glm::distance(j, point), {j, sign * out}};
    }
    const bool isCone = s.shape == SpecialShape::Cone;
    const double sine = std::sin(s.halfAngleRadians), cosine = std::cos(s.halfAngleRadians);
    const dvec3 base = isCone ? s.origin : s.origin + s.radius * out,
                along = isCone ? cosine * s.axis + sine * out : s.axis,
                normal = isCone ? cosine * out - sine * s.axis : out;
    const dvec3 e = eye - base, q = point - base;
    const double e0 = glm::dot(e, along), q0 = glm::dot(q, along);
    const double eh = glm::length(e - e0 * along), qh = glm::length(q - q0 * along);
    return Path{std::hypot(e0 - q0, eh + qh),
                {base + along * ((e0 * qh + q0 * eh) / (eh + qh)), sign * normal}};
  };
}

TEST_P(Special, NoReflectionIsMissed) {
  const SpecialReflector shape = makeShape(GetParam().shape, GetParam().isInside);
  if (shape.shape == SpecialShape::Plane) return;  // there is one formula and one answer
  std::mt19937 random(12);
  constexpr int kSamples = 1500;
  const int pairs = std::max(200, pairCount() / 1000);
  int expected = 0, several = 0;
  for (int i = 0; i < pairs; ++i) {
    const dvec3 eye = randomPoint(random, shape.origin), point = randomPoint(random, shape.origin);
    const Reflections found = findReflections(shape, eye, point);
    several += found.count > 1;
    const PathOver pathOver = makePathOver(shape, eye, point);
    std::vector<Path> paths;
    paths.reserve(kSamples);
    for (int k = 0; k < kSamples; ++k) paths.push_back(pathOver(6.283185307179586 * k / kSamples));
    for (int k = 0; k < kSamples; ++k) {  // where the path is stationary by sampling (Fermat)
      const Path &before = paths[std::size_t((k + kSamples - 1) % kSamples)], &here = paths[std::size_t(k)],
                 &after = paths[std::size_t((k + 1) % kSamples)];
      if ((here.length - before.length) * (after.length - here.length) > 0) continue;
      const Reflection& j = here.at;
      const double least = std::min(glm::dot(j.normal, glm::normalize(eye - j.position)),
                                    glm::dot(j.normal, glm::normalize(point - j.position)));
      if (least < 0.05) continue;  // behind, or grazing, where sampling is no judge
      if (shape.shape == SpecialShape::Cone && glm::dot(j.position - shape.origin, shape.axis) < 0.02)
        continue;
      ++expected;
      const double reach = 0.02 * (1 + glm::distance(j.position, shape.origin));
      bool isThere = false;
      for (const Reflection& r : found) isThere = isThere || glm::distance(r.position, j.position) < reach;
      EXPECT_TRUE(isThere) << "pair " << i << " at sample " << k;
    }
  }
  EXPECT_GT(expected, pairs / 10);
  EXPECT_TRUE(!GetParam().isInside || several > 0);
}

TEST_P(Special, DegenerateInputStaysFinite) {
  const SpecialReflector shape = makeShape(GetParam().shape, GetParam().isInside);
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
