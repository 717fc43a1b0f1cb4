// SPDX-License-Identifier: Apache-2.0
// Implicit surfaces by search: the mirror law, and whether every reflection is found: on a sphere as many as
// in closed form, outside of a convex body one. (On all surfaces: all_roots_test.cpp.)
// CATOPTRIC_PAIRS=1000000 tries that many pairs of eye and point on each surface.
#include "catoptric/virtual_object/implicit_reflector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "catoptric/geometry/shapes.h"
#include "implicit_cases.h"
#include "special_cases.h"

namespace catoptric::virtual_object {
namespace {

int pairCount() {
  const char* text = std::getenv("CATOPTRIC_PAIRS");
  return text ? std::max(1, std::atoi(text)) : 1500;
}

TEST(Implicit, EveryAnswerObeysTheMirrorLawOnTheSurface) {
  for (const ImplicitCase& c : makeImplicitCases()) {
    const Surface surface = fitSurface(c);
    const ImplicitReflector reflector(surface, c.isTurned, viewMesh(c.mesh), 0.7);
    std::mt19937 random(7);
    std::size_t answers = 0;
    int most = 0;
    double worst = 0;
    for (int i = 0; i < pairCount(); ++i) {
      const Pair pair = randomPair(random, c, surface);
      const ImplicitReflections found = reflector.findReflections(pair.eye, pair.point);
      most = std::max(most, found.count);
      for (const Reflection& r : found) {
        ++answers;
        if (std::min(glm::distance(r.position, pair.eye), glm::distance(r.position, pair.point)) < 1e-6)
          continue;
        worst = std::max(worst, sineAt(r, pair.eye, pair.point));
        ASSERT_NEAR(surface->value(r.position) / glm::length(surface->gradient(r.position)), 0, 1e-9)
            << c.name;
        ASSERT_GT(glm::dot(r.normal, pair.eye - r.position), 0);
        ASSERT_GT(glm::dot(r.normal, pair.point - r.position), 0);
      }
    }
    std::printf("%-18s %zu answers, %d for one pair, largest sine %.1e\n", c.name, answers, most, worst);
    EXPECT_LE(worst, 1e-9) << c.name;
    EXPECT_GT(answers, std::size_t(pairCount()) / 10) << c.name;
    EXPECT_LT(most, ImplicitReflections::kMost) << c.name;
  }
}

TEST(Implicit, OnASphereTheSearchFindsWhatTheClosedFormFinds) {
  const geometry::Mesh mesh = geometry::makeIcosphere(0.7, 12);
  for (const bool isInside : {false, true}) {
    const SpecialReflector closed{SpecialShape::Sphere, dvec3(0), {0, 0, 1}, 0.7, 0, isInside};
    const ImplicitReflector reflector(std::make_shared<geometry::Quadric>(makeEllipsoid(dvec3(0.7))),
                                      isInside, viewMesh(mesh), 0.7);
    std::mt19937 random(9);
    ImplicitCase ball;
    ball.reach = isInside ? 0.65 : 4.0;
    int expected = 0, found = 0;
    for (int i = 0; i < pairCount(); ++i) {
      const Pair pair = randomPair(random, ball);
      const ImplicitReflections searched = reflector.findReflections(pair.eye, pair.point);
      for (const Reflection& r : findReflections(closed, pair.eye, pair.point)) {
        ++expected;
        for (const Reflection& s : searched) found += glm::distance(r.position, s.position) < 1e-6 ? 1 : 0;
      }
    }
    std::printf("sphere %s: %d of %d reflections\n", isInside ? "inside" : "outside", found, expected);
    EXPECT_GT(expected, pairCount() / 4);
    EXPECT_EQ(found, expected);
  }
}

TEST(Implicit, OutsideAnEllipsoidThereIsOneWhereItIsNotInTheShadow) {
  const dvec3 half(0.7, 0.5, 0.4);
  const geometry::Mesh mesh = stretch(geometry::makeIcosphere(1, 12), half);
  const ImplicitReflector reflector(std::make_shared<geometry::Quadric>(makeEllipsoid(half)), false,
                                    viewMesh(mesh), 0.7);
  std::mt19937 random(3);
  int wrong = 0, pairs = 0;
  for (int i = 0; i < pairCount(); ++i) {
    const Pair pair{3.0 * randomDirection(random), 2.0 * randomDirection(random)};
    const dvec3 e = pair.eye / half, d = pair.point / half - e;  // there the ellipsoid is the unit sphere
    const double clearance = glm::length(e + std::clamp(-glm::dot(e, d) / glm::dot(d, d), 0.0, 1.0) * d) - 1;
    if (std::abs(clearance) < 0.01) continue;
    ++pairs;
    const ImplicitReflections all = reflector.findReflections(pair.eye, pair.point);
    wrong += all.count != (clearance > 0 ? 1 : 0) ? 1 : 0;
  }
  EXPECT_GT(pairs, pairCount() / 2);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace catoptric::virtual_object
