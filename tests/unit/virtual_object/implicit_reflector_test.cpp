// SPDX-License-Identifier: Apache-2.0
// Implicit surfaces by search: the mirror law, and whether every reflection is found. Judges of the latter:
// the closed form, on a sphere; uniqueness, outside of a convex body; many times as many starts, elsewhere.
// CATOPTRIC_PAIRS=1000000 tries that many pairs of eye and point on each surface.
#include "catoptric/virtual_object/implicit_reflector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

int pairCount() {
  const char* text = std::getenv("CATOPTRIC_PAIRS");
  return text ? std::max(1, std::atoi(text)) : 1500;
}

/// Ellipsoid of these half axes around the origin, bright outside.
geometry::Quadric makeEllipsoid(const dvec3& half) {
  geometry::Quadric q;
  for (int k = 0; k < 3; ++k) q.a[k][k] = 1 / (half[k] * half[k]);
  q.c = -1;
  return q;
}

geometry::Mesh stretch(geometry::Mesh mesh, const dvec3& half) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.positions[i] *= vec3(half);
    mesh.normals[i] = glm::normalize(mesh.normals[i] / vec3(half));
  }
  return mesh;
}

geometry::Mesh makeDish(double curvatureX, double curvatureY) {  // z = cx x^2 + cy y^2, bright above
  return geometry::makeHeightField(
      24, 24, [](dvec2 at) { return 0.6 * at; },
      [=](dvec2 at) {
        return geometry::HeightSample{curvatureX * at.x * at.x + curvatureY * at.y * at.y,
                                      2 * curvatureX * at.x, 2 * curvatureY * at.y};
      });
}

struct Case {
  const char* name;
  geometry::Mesh mesh;
  bool isTurned = false;  ///< bright side: the hollow one
  double reach = 4;       ///< of eyes and points, from the middle
};

std::vector<Case> makeCases() {
  const geometry::Mesh ball = geometry::makeIcosphere(1, 12);
  return {{"ellipsoid outside", stretch(ball, {0.7, 0.5, 0.4})},
          {"ellipsoid inside", stretch(ball, {0.7, 0.5, 0.4}), true, 0.38},
          {"dish", makeDish(0.5, 0.35)},
          {"saddle", makeDish(0.4, -0.3)},
          {"bump", makeDish(-0.5, -0.2)}};
}

geometry::Quadric fit(const Case& c) {
  const auto found = geometry::fitQuadric({c.mesh.positions, c.mesh.normals, c.mesh.indices});
  EXPECT_TRUE(found.has_value()) << c.name;
  EXPECT_LT(found->deviation.distance, 1e-6) << c.name;
  return c.isTurned ? found->quadric.flipped() : found->quadric;
}

struct Pair {
  dvec3 eye, point;
};

Pair randomPair(std::mt19937& random, const Case& c) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto place = [&] { return c.reach * std::cbrt(uniform(random)) * randomDirection(random); };
  return {place(), place()};
}

double sineAt(const Reflection& r, const Pair& pair) {
  const dvec3 half = glm::normalize(pair.eye - r.position) + glm::normalize(pair.point - r.position);
  return glm::length(glm::cross(glm::normalize(half), r.normal));
}

TEST(Implicit, EveryAnswerObeysTheMirrorLawOnTheSurface) {
  for (const Case& c : makeCases()) {
    const geometry::Quadric surface = fit(c);
    const ImplicitReflector reflector(surface, c.mesh.positions, 0.7);
    std::mt19937 random(7);
    std::size_t answers = 0;
    double worst = 0;
    for (int i = 0; i < pairCount(); ++i) {
      const Pair pair = randomPair(random, c);
      for (const Reflection& r : reflector.findReflections(pair.eye, pair.point)) {
        ++answers;
        if (std::min(glm::distance(r.position, pair.eye), glm::distance(r.position, pair.point)) < 1e-6)
          continue;
        worst = std::max(worst, sineAt(r, pair));
        ASSERT_NEAR(surface.value(r.position) / glm::length(surface.gradient(r.position)), 0, 1e-9) << c.name;
        ASSERT_GT(glm::dot(r.normal, pair.eye - r.position), 0);
        ASSERT_GT(glm::dot(r.normal, pair.point - r.position), 0);
      }
    }
    std::printf("%-18s %zu answers, largest sine %.1e\n", c.name, answers, worst);
    EXPECT_LE(worst, 1e-9) << c.name;
    EXPECT_GT(answers, std::size_t(pairCount()) / 10) << c.name;
  }
}

TEST(Implicit, OnASphereTheSearchFindsWhatTheClosedFormFinds) {
  const geometry::Mesh mesh = geometry::makeIcosphere(0.7, 12);
  for (const bool isInside : {false, true}) {
    const SpecialReflector closed{SpecialShape::Sphere, dvec3(0), {0, 0, 1}, 0.7, 0, isInside};
    const geometry::Quadric sphere = makeEllipsoid(dvec3(0.7));
    const ImplicitReflector reflector(isInside ? sphere.flipped() : sphere, mesh.positions, 0.7);
    std::mt19937 random(9);
    int expected = 0, found = 0;
    for (int i = 0; i < pairCount(); ++i) {
      const Pair pair = randomPair(random, {"", {}, isInside, isInside ? 0.65 : 4.0});
      const ImplicitReflections searched = reflector.findReflections(pair.eye, pair.point);
      for (const Reflection& r : findReflections(closed, pair.eye, pair.point)) {
        ++expected;
        for (const Reflection& s : searched) found += glm::distance(r.position, s.position) < 1e-6 ? 1 : 0;
      }
    }
    std::printf("sphere %s: %d of %d reflections\n", isInside ? "inside" : "outside", found, expected);
    EXPECT_GT(expected, pairCount() / 4);
    EXPECT_GE(found,
              isInside ? 0.995 * expected : 0.9999 * expected);  // inside: pairs of roots near a caustic
  }
}

TEST(Implicit, OutsideAnEllipsoidThereIsOneWhereItIsNotInTheShadow) {
  const dvec3 half(0.7, 0.5, 0.4);
  const geometry::Mesh mesh = stretch(geometry::makeIcosphere(1, 12), half);
  const ImplicitReflector reflector(makeEllipsoid(half), mesh.positions, 0.7);
  std::mt19937 random(3);
  int wrong = 0, pairs = 0;
  for (int i = 0; i < pairCount(); ++i) {
    const Pair pair{3.0 * randomDirection(random), 2.0 * randomDirection(random)};
    const dvec3 e = pair.eye / half, d = pair.point / half - e;  // there the ellipsoid is the unit sphere
    const double clearance = glm::length(e + std::clamp(-glm::dot(e, d) / glm::dot(d, d), 0.0, 1.0) * d) - 1;
    if (std::abs(clearance) < 0.01) continue;
    ++pairs;
    wrong += reflector.findReflections(pair.eye, pair.point).count != (clearance > 0 ? 1 : 0) ? 1 : 0;
  }
  EXPECT_GT(pairs, pairCount() / 2);
  EXPECT_EQ(wrong, 0);
}

TEST(Implicit, ManyTimesAsManyStartsFindNoMoreOnTheMirror) {
  for (const Case& c : makeCases()) {
    const geometry::Quadric surface = fit(c);
    const ImplicitReflector usual(surface, c.mesh.positions, 0.7),
        dense(surface, c.mesh.positions, 0.7, 1200);
    std::mt19937 random(13);
    int expected = 0, found = 0;
    for (int i = 0; i < std::max(500, pairCount() / 1000); ++i) {
      const Pair pair = randomPair(random, c);
      const ImplicitReflections few = usual.findReflections(pair.eye, pair.point);
      for (const Reflection& r : dense.findReflections(pair.eye, pair.point)) {
        if (glm::length(r.position) > 0.8) continue;
        ++expected;
        for (const Reflection& s : few) found += glm::distance(r.position, s.position) < 1e-5 ? 1 : 0;
      }
    }
    std::printf("%-18s %d of %d reflections\n", c.name, found, expected);
    EXPECT_GT(expected, 20) << c.name;
    EXPECT_GE(found, 0.99 * expected) << c.name;
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
