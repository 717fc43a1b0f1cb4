// SPDX-License-Identifier: Apache-2.0
// Eight vertices at once, in float, against one at a time, in double: the same law, the same reflection
// points to a small part of a pixel, the same choice of what is reflected.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/lane_search.h"
#include "catoptric/virtual_object/reflection_point.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

/// Pixels of a picture in which the mirror is 700 wide, per radian at the eye.
double pixelsPerRadian(const ReflectorMesh& mesh, const dvec3& eye) {
  return 700 * glm::length(eye - mesh.centre()) / (2 * mesh.bodyRadius());
}

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(Lanes, theLawAndItsDerivativesAreThoseOfTheDoubleSearch) {
  const ReflectorMesh mesh = meshOf(geometry::makeUvSphere(0.5, 40, 20));
  const std::vector<LaneTriangle> triangles = makeLaneTriangles(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.1, 0.4);
  for (int round = 0; round < 200; ++round) {
    const dvec3 eye = 2.0 * randomDirection(random);
    LaneView view;
    view.triangles = triangles;
    view.centre = vec3(mesh.centre());
    view.eye = vec3(eye - mesh.centre());
    LaneGroup group;
    std::array<dvec3, kLanes> points;
    for (int lane = 0; lane < kLanes; ++lane) {
      group.triangle[lane] = std::int32_t(random() % mesh.ordinaryCount());
      points[lane] = 1.5 * randomDirection(random);
      for (int k = 0; k < 3; ++k) group.point[k][lane] = float(points[lane][k]);
      group.u[lane] = float(share(random)), group.v[lane] = float(share(random));
    }
    const LaneLaw lanes = evaluateLanes(view, group);
    for (int lane = 0; lane < kLanes; ++lane) {
      const MirrorTriangle& t = mesh.triangles()[std::size_t(group.triangle[lane])];
      const MirrorLaw law = evaluateMirrorLaw(t, group.u[lane], group.v[lane], eye, points[lane]);
      if (glm::dot(law.h, law.h) < 0.01) continue;  // grazing: floats are not used there
      EXPECT_NEAR(lanes.squaredSine[lane], law.squaredSine(), 1e-4);
      EXPECT_NEAR(lanes.facing[lane], law.hn, 1e-5);
      EXPECT_NEAR(lanes.distance[lane], law.distancePoint, 1e-5);
      const dvec2 step = computeNewtonStep(t, law);
      if (glm::length(step) > 100) continue;  // nearly singular
      EXPECT_NEAR(lanes.stepU[lane], step.x, 1e-2 * glm::length(step) + 1e-3);
      EXPECT_NEAR(lanes.stepV[lane], step.y, 1e-2 * glm::length(step) + 1e-3);
    }
  }
}

/// Far past an open boundary the lanes may give up where doubles go on, and the other way round.
VertexKind withoutBoundary(VertexKind kind) {
  return kind == VertexKind::PastBoundary ? VertexKind::DoublyVirtual : kind;
}

struct Difference {
  double largestPx = 0;
  int otherwiseReflected = 0, otherKind = 0, reflected = 0, hidden = 0;
};

Difference compareWithDoubles(const ReflectorMesh& mesh, const dvec3& eye, double reach) {
  EXPECT_TRUE(mesh.isConvex());
  const VirtualObjectSolver solver(mesh, eye, 20.0);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<vec3> points;
  dvec3 at(0);
  for (int i = 0; i < 6000; ++i) {  // runs of neighbours, as vertices of objects are
    if (i % 12 == 0)
      at = mesh.centre() + mesh.radius() * (1.0 + reach * uniform(random)) * randomDirection(random);
    at += 0.03 * mesh.radius() * randomDirection(random);
    points.push_back(vec3(at));
  }
  std::vector<vec3> virtualPositions(points.size()), reflectionPoints(points.size());
  std::vector<VertexKind> kinds(points.size());
  solver.compute(Solver::Refined, points, virtualPositions, kinds, reflectionPoints);
  Difference difference;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto alone = solver.findReflectionPoint(Solver::Refined, points[i]);
    const VertexKind kind = alone ? alone->kind : VertexKind::None;
    difference.otherwiseReflected += (kind == VertexKind::Reflected) != (kinds[i] == VertexKind::Reflected);
    difference.otherKind += withoutBoundary(kind) != withoutBoundary(kinds[i]);
    // A doubly virtual vertex of a closed mirror is hidden by it; past an open edge the lanes may go on
    // elsewhere.
    const bool isHidden =
        kind == VertexKind::DoublyVirtual && mesh.ordinaryCount() == mesh.triangles().size();
    if ((kind != VertexKind::Reflected && !isHidden) || kinds[i] != kind) continue;
    ++(isHidden ? difference.hidden : difference.reflected);
    const double angle = angleBetween(dvec3(virtualPositions[i]) - eye, alone->virtualPosition - eye);
    difference.largestPx = std::max(difference.largestPx, angle * pixelsPerRadian(mesh, eye));
    EXPECT_NEAR(glm::length(dvec3(virtualPositions[i]) - eye), glm::length(alone->virtualPosition - eye),
                1e-5 * glm::length(alone->virtualPosition - eye));
    EXPECT_NEAR(glm::length(dvec3(reflectionPoints[i]) - alone->position), 0, 1e-4 * mesh.radius());
  }
  return difference;
}

TEST(Lanes, findTheSameReflectionPointsToASmallPartOfAPixel) {
  const struct {
    const char* name;
    geometry::Mesh mesh;
    dvec3 eye;
    double reach;
    int mostOther = 6;
  } cases[] = {
      {"sphere", geometry::makeIcosphere(0.5, 24), {0.4, 0.9, 2.6}, 6},
      {"coarse sphere", geometry::makeIcosphere(0.5, 5), {0.4, 0.9, 2.6}, 6},
      {"cylinder", geometry::makeCylinderSide(0.3, 1.6, 96, 12, false), {0.4, 0.9, 2.6}, 3},
      // Past its tip the continued cone is inside out: searches go astray there, each in its own way.
      {"cut cone",
       geometry::makeRevolvedSide(0.52, 144, 20,
                                  [](double y) {
                                    return geometry::RadiusSample{0.26 - 0.4 * y, -0.4};
                                  }),
       {0.2, 1.1, 1.25},
       8,
       45},
      {"far away",
       geometry::transformed(geometry::makeIcosphere(0.5, 12), geometry::moveBy({200, 0, 90})),
       {202, 1, 91},
       40}};
  int hidden = 0;
  for (const auto& c : cases) {
    const Difference difference = compareWithDoubles(meshOf(c.mesh), c.eye, c.reach);
    hidden += difference.hidden;
    EXPECT_GT(difference.reflected, 1000) << c.name;
    // 0.05 px: a tenth of the default --max-error. A point at the very edge of the mirror may fall to either
    // side.
    EXPECT_LT(difference.largestPx, 0.05) << c.name;
    EXPECT_LE(difference.otherwiseReflected, 6) << c.name;
    EXPECT_LE(difference.otherKind, c.mostOther) << c.name;
  }
  EXPECT_GT(hidden, 100);
}

TEST(Lanes, theirNeighboursDecideNothing) {
  const ReflectorMesh mesh = meshOf(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false));
  const VirtualObjectSolver solver(mesh, {0.4, 0.9, 2.6}, 20.0);
  std::mt19937 random(13);
  std::vector<vec3> points;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < 2000; ++i) {
    points.emplace_back(mesh.centre() + (1.05 + 0.002 * double(i)) * mesh.radius() * randomDirection(random));
    order.push_back(i);
  }
  std::shuffle(order.begin(), order.end(), random);
  std::vector<vec3> shuffled(points.size()), placed(points.size()), placedShuffled(points.size());
  std::vector<VertexKind> kinds(points.size()), kindsShuffled(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) shuffled[i] = points[order[i]];
  solver.compute(Solver::Refined, points, placed, kinds);
  solver.compute(Solver::Refined, shuffled, placedShuffled, kindsShuffled);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(kindsShuffled[i], kinds[order[i]]) << points[order[i]].x;
    ASSERT_EQ(placedShuffled[i], placed[order[i]]);
  }
}

struct EndsOfTwo {
  int otherwiseReflected = 0, otherKind = 0;
  double largestPx = 0;
};

/// The same points once from where they were last, and once anew.
EndsOfTwo compareWithNewSearches(const VirtualObjectSolver& solver, std::span<const vec3> points,
                                 LanePlaces& places) {
  const dvec3 eye = solver.eye();
  std::vector<vec3> placed(points.size()), placedAnew(points.size());
  std::vector<VertexKind> kinds(points.size()), kindsAnew(points.size());
  solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
  VirtualObjectSolver(solver.mesh(), eye, 20.0).compute(Solver::Refined, points, placedAnew, kindsAnew);
  EndsOfTwo ends;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ends.otherwiseReflected += (kinds[i] == VertexKind::Reflected) != (kindsAnew[i] == VertexKind::Reflected);
    ends.otherKind += withoutBoundary(kinds[i]) != withoutBoundary(kindsAnew[i]);
    if (kinds[i] != VertexKind::Reflected || kindsAnew[i] != kinds[i]) continue;
    const double angle = angleBetween(dvec3(placed[i]) - eye, dvec3(placedAnew[i]) - eye);
    ends.largestPx = std::max(ends.largestPx, angle * pixelsPerRadian(solver.mesh(), eye));
  }
  return ends;
}

TEST(Lanes, whereTheyBeginDecidesNothing) {
  const ReflectorMesh mesh = meshOf(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false));
  std::mt19937 random(12);
  std::vector<vec3> points;
  points.reserve(3000);
  for (int i = 0; i < 3000; ++i)
    points.emplace_back(mesh.centre() + (1.1 + 0.001 * i) * mesh.radius() * randomDirection(random));
  std::vector<vec3> placed(points.size());
  std::vector<VertexKind> kinds(points.size());
  const dvec3 firstEye(0.4, 0.9, 2.6);
  VirtualObjectSolver solver(mesh, firstEye, 20.0, {.mapsServeWithin = 0.2});
  const dvec3 mapsTurn = solver.nearMap().frame.z;
  for (const int stepsBetween : {1, 60}) {  // a frame each
    LanePlaces places;
    dvec3 lastEye = firstEye;
    solver.setEye(firstEye);
    solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
    const auto known = std::count_if(places.begin(), places.end(), [](auto& p) { return p.isSeen(); });
    EXPECT_GT(std::size_t(known), points.size() / 3);
    for (const dvec3 eye :
         {dvec3(0.41, 0.9, 2.6), dvec3(0.5, 0.95, 2.5), dvec3(0.4, 1.6, 2.2), dvec3(-2.6, 0.4, -0.4)}) {
      for (int i = 1; i < stepsBetween; ++i) {
        solver.setEye(glm::mix(lastEye, eye, double(i) / stepsBetween));
        solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
      }
      lastEye = eye;
      solver.setEye(eye);
      if (stepsBetween == 1) {  // maps are kept
        EXPECT_EQ(solver.nearMap().frame.z == mapsTurn, glm::length(eye - firstEye) < 0.2);
      }
      const EndsOfTwo ends = compareWithNewSearches(solver, points, places);
      EXPECT_LT(ends.largestPx, 0.05);
      EXPECT_LE(ends.otherwiseReflected, stepsBetween == 1 ? 0 : 1);  // at the very edge of the mirror
      EXPECT_LE(ends.otherKind, 15);  // far past the open edge: a doubly virtual place, or given up
    }
  }
}

TEST(Lanes, placesOfAMirrorThatHadMoreTrianglesDoNoHarm) {
  const ReflectorMesh mesh = meshOf(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false));
  const VirtualObjectSolver solver(mesh, {0.4, 0.9, 2.6}, 20.0);
  std::mt19937 random(12);
  std::vector<vec3> points;
  points.reserve(300);
  for (int i = 0; i < 300; ++i)
    points.emplace_back(mesh.centre() + (1.1 + 0.01 * i) * mesh.radius() * randomDirection(random));
  std::vector<vec3> placed(points.size());
  std::vector<VertexKind> kinds(points.size()), kindsAnew(points.size());
  solver.compute(Solver::Refined, points, placed, kindsAnew);
  for (const float lostBy : {0.0f, 0.1f}) {
    LanePlaces places(points.size(), {1 << 30, 0, 0, lostBy});
    solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
    EXPECT_EQ(kinds, kindsAnew);
  }
}

TEST(Lanes, whatNearlyTouchesBeginsWhereItWasFoundToo) {
  const ReflectorMesh mesh = meshOf(geometry::makeCylinderSide(0.3, 1.6, 96, 12, false));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> height(-0.7, 0.7), angle(0, 1.2), gap(1.0002, 1.003);
  std::vector<vec3> points;
  for (int i = 0; i < 500; ++i) {
    const double a = angle(random), r = 0.3 * gap(random);
    points.emplace_back(mesh.centre() + dvec3(r * std::sin(a), height(random), r * std::cos(a)));
  }
  std::vector<vec3> placed(points.size()), placedAnew(points.size());
  std::vector<VertexKind> kinds(points.size()), kindsAnew(points.size());
  VirtualObjectSolver solver(mesh, {0.4, 0.9, 2.6}, 20.0);
  LanePlaces places;
  solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(places[i].isSeen(), kinds[i] == VertexKind::Reflected);
  for (const dvec3 eye : {dvec3(0.41, 0.9, 2.6), dvec3(1.4, 0.6, 2.2), dvec3(-2.6, 0.4, -0.4)}) {
    solver.setEye(eye);
    solver.compute(Solver::Refined, points, placed, kinds, {}, {}, &places);
    VirtualObjectSolver(mesh, eye, 20.0).compute(Solver::Refined, points, placedAnew, kindsAnew);
    EXPECT_EQ(kinds, kindsAnew);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (kinds[i] == VertexKind::Reflected) {
        EXPECT_LT(
            angleBetween(dvec3(placed[i]) - eye, dvec3(placedAnew[i]) - eye) * pixelsPerRadian(mesh, eye),
            0.05);
      }
  }
}

TEST(Lanes, nothingFiniteComesOfNothing) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 8));
  const VirtualObjectSolver solver(mesh, {0, 1, 2}, 6.0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<vec3> points(37, vec3(nan, 0, 0)), out(points.size());
  points[20] = {1, 1, 1};
  std::vector<VertexKind> kinds(points.size(), VertexKind::Reflected);
  solver.compute(Solver::Refined, points, out, kinds);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(kinds[i], i == 20 ? VertexKind::Reflected : VertexKind::None) << i;
  solver.compute(Solver::Refined, {}, {}, {});
}

}  // namespace
}  // namespace catoptric::virtual_object
