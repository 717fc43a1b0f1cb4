// SPDX-License-Identifier: Apache-2.0
// Implicit surfaces by search: the mirror law, and whether every reflection is found. Judges of the latter:
// the closed form, on a sphere; uniqueness, outside of a convex body; many times as many starts, elsewhere.
// CATOPTRIC_PAIRS=1000000 tries that many pairs of eye and point on each surface.
#include "catoptric/virtual_object/implicit_reflector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <memory>

#include "catoptric/geometry/aspheric_mirror.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/torus.h"
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

/// z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + a6 r^6 within r = 0.6, by the textbook's formula.
geometry::Mesh makeAspheric(double c, double k, double a4, double a6) {
  return geometry::makeHeightField(
      24, 24, [](dvec2 at) { return 0.42 * at; },
      [=](dvec2 at) {
        const double u = glm::dot(at, at), root = std::sqrt(1 - (1 + k) * c * c * u);
        const double slope = c / root + 4 * a4 * u + 6 * a6 * u * u;  // over r
        return geometry::HeightSample{c * u / (1 + root) + u * u * (a4 + a6 * u), slope * at.x, slope * at.y};
      });
}

using Surface = std::shared_ptr<const geometry::ImplicitSurface>;
enum class Family { Quadric, Torus, Aspheric };

struct Case {
  const char* name;
  geometry::Mesh mesh;
  bool isTurned = false;  ///< bright side: the hollow one
  double reach = 4;       ///< of eyes and points, from the middle
  Family family = Family::Quadric;
  bool isWithin = false;  ///< eyes and points: only where f < 0 before it is turned
};

std::vector<Case> makeCases() {
  const geometry::Mesh ball = geometry::makeIcosphere(1, 12);
  const geometry::Mesh ring = geometry::makeTorus(0.5, 0.2, 64, 32);
  return {{"ellipsoid outside", stretch(ball, {0.7, 0.5, 0.4})},
          {"ellipsoid inside", stretch(ball, {0.7, 0.5, 0.4}), true, 0.38},
          {"dish", makeDish(0.5, 0.35)},
          {"saddle", makeDish(0.4, -0.3)},
          {"bump", makeDish(-0.5, -0.2)},
          {"torus outside", ring, false, 4, Family::Torus},
          {"torus near", ring, false, 1, Family::Torus},
          {"torus inside", ring, true, 0.7, Family::Torus, true},
          {"aspheric bulge", makeAspheric(-0.8, 0.4, -0.3, -0.25), false, 4, Family::Aspheric},
          {"aspheric hollow", makeAspheric(0.8, -0.5, 0.25, -0.2), false, 4, Family::Aspheric},
          {"aspheric turned", makeAspheric(-0.8, 0.4, -0.3, -0.25), true, 4, Family::Aspheric}};
}

Surface fit(const Case& c) {
  const geometry::MeshView mesh{c.mesh.positions, c.mesh.normals, c.mesh.indices};
  const auto keep = [&](const auto& found, auto member) -> Surface {
    EXPECT_TRUE(found.has_value()) << c.name;
    EXPECT_LT(found->deviation.distance, 1e-6) << c.name;
    using Found = std::remove_cvref_t<decltype((*found).*member)>;
    return std::make_shared<Found>((*found).*member);
  };
  if (c.family == Family::Torus) return keep(geometry::fitTorus(mesh), &geometry::TorusFit::torus);
  if (c.family == Family::Aspheric)
    return keep(geometry::fitAsphericMirror(mesh), &geometry::AsphericFit::mirror);
  return keep(geometry::fitQuadric(mesh), &geometry::QuadricFit::quadric);
}

struct Pair {
  dvec3 eye, point;
};

Pair randomPair(std::mt19937& random, const Case& c, const Surface& surface = nullptr) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto place = [&] {
    while (true) {
      const dvec3 at = c.reach * std::cbrt(uniform(random)) * randomDirection(random);
      if (!c.isWithin || surface->value(at) < 0) return at;
    }
  };
  const dvec3 eye = place();
  return {eye, place()};
}

double sineAt(const Reflection& r, const Pair& pair) {
  const dvec3 half = glm::normalize(pair.eye - r.position) + glm::normalize(pair.point - r.position);
  return glm::length(glm::cross(glm::normalize(half), r.normal));
}

TEST(Implicit, EveryAnswerObeysTheMirrorLawOnTheSurface) {
  for (const Case& c : makeCases()) {
    const Surface surface = fit(c);
    const ImplicitReflector reflector(surface, c.isTurned, c.mesh.positions, 0.7);
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
        worst = std::max(worst, sineAt(r, pair));
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
                                      isInside, mesh.positions, 0.7);
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
    EXPECT_GE(found, 0.9995 * expected);  // inside: pairs of roots near a caustic
  }
}

TEST(Implicit, OutsideAnEllipsoidThereIsOneWhereItIsNotInTheShadow) {
  const dvec3 half(0.7, 0.5, 0.4);
  const geometry::Mesh mesh = stretch(geometry::makeIcosphere(1, 12), half);
  const ImplicitReflector reflector(std::make_shared<geometry::Quadric>(makeEllipsoid(half)), false,
                                    mesh.positions, 0.7);
  std::mt19937 random(3);
  int wrong = 0, pairs = 0, fromBestSeed = 0;
  for (int i = 0; i < pairCount(); ++i) {
    const Pair pair{3.0 * randomDirection(random), 2.0 * randomDirection(random)};
    const dvec3 e = pair.eye / half, d = pair.point / half - e;  // there the ellipsoid is the unit sphere
    const double clearance = glm::length(e + std::clamp(-glm::dot(e, d) / glm::dot(d, d), 0.0, 1.0) * d) - 1;
    if (std::abs(clearance) < 0.01) continue;
    ++pairs;
    const ImplicitReflections all = reflector.findReflections(pair.eye, pair.point);
    wrong += all.count != (clearance > 0 ? 1 : 0) ? 1 : 0;
    const auto first = reflector.findFromBestSeed(pair.eye, pair.point);
    if (first) {
      ++fromBestSeed;
      wrong += !(glm::distance(first->position, all.all[0].position) < 1e-6) ? 1 : 0;
    }
  }
  EXPECT_GT(pairs, pairCount() / 2);
  EXPECT_GT(fromBestSeed, pairs / 2);
  EXPECT_EQ(wrong, 0);
}

TEST(Implicit, ManyTimesAsManyStartsFindNoMoreOnTheMirror) {
  for (const Case& c : makeCases()) {
    const Surface surface = fit(c);
    const ImplicitReflector usual(surface, c.isTurned, c.mesh.positions, 0.7),
        dense(surface, c.isTurned, c.mesh.positions, 0.7, 1200);
    std::mt19937 random(13);
    int expected = 0, found = 0;
    for (int i = 0; i < std::max(500, pairCount() / 1000); ++i) {
      const Pair pair = randomPair(random, c, surface);
      const ImplicitReflections few = usual.findReflections(pair.eye, pair.point);
      for (const Reflection& r : dense.findReflections(pair.eye, pair.point)) {
        if (glm::length(r.position) > 0.8) continue;
        ++expected;
        for (const Reflection& s : few) found += glm::distance(r.position, s.position) < 1e-5 ? 1 : 0;
      }
    }
    std::printf("%-18s %d of %d reflections\n", c.name, found, expected);
    EXPECT_GT(expected, 20) << c.name;
    EXPECT_GE(found, 0.995 * expected) << c.name;
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
