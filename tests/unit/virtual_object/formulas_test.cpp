// SPDX-License-Identifier: Apache-2.0
// The mirror law of shaders/lib, which the vertex shader searches with, against that of the double search.
#include "catoptric/virtual_object/formulas.h"

#include <gtest/gtest.h>

#include <random>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/reflection_point.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

TEST(Formulas, theLawOfTheVertexShaderIsThatOfTheDoubleSearch) {
  const ReflectorMesh mesh = meshOf(geometry::makeUvSphere(0.5, 40, 20));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0.1, 0.4);
  int steps = 0;
  for (int round = 0; round < 2000; ++round) {
    const dvec3 eye = 2.0 * randomDirection(random), point = 1.5 * randomDirection(random);
    const MirrorTriangle& t = mesh.triangles()[random() % mesh.ordinaryCount()];
    const dvec2 uv(share(random), share(random));
    const MirrorLaw law = evaluateMirrorLaw(t, uv.x, uv.y, eye, point);
    const formulas::MirrorFacet facet{t.position0, t.edge1, t.edge2, t.normal0, t.normal1, t.normal2};
    const formulas::LawOnFacet same = formulas::lawOnFacet(facet, uv, eye, point);
    EXPECT_NEAR(same.hn, law.hn, 1e-12);
    EXPECT_NEAR(glm::length(same.position - law.position), 0, 1e-14);
    if (glm::dot(law.h, law.h) < 1e-4) continue;
    EXPECT_NEAR(formulas::squaredSineOf(same), law.squaredSine(), 1e-9);
    EXPECT_NEAR(formulas::squaredMeritOf(same), law.squaredMerit(), 1e-12);
    const dvec2 step = computeNewtonStep(t, law), sameStep = formulas::newtonStepOnFacet(facet, same);
    if (!(glm::length(step) < 100)) continue;  // nearly singular
    EXPECT_NEAR(glm::length(sameStep - step), 0, 1e-9 * (1 + glm::length(step)));
    ++steps;
  }
  EXPECT_GT(steps, 1000);
}

TEST(Formulas, aRadiusMeetsTheOutlineWhereTheNearestEdgeDoes) {
  const dvec2 a(0.2, 0.1), b(0.5, 0.15), c(0.3, 0.4), centre(0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 200; ++i) {  // a point beyond the edge from b to c, on a radius through it
    const double along = share(random);
    const dvec2 onEdge = glm::mix(b, c, along), uv = formulas::uvOnOutline(a, b, c, centre, 1.4 * onEdge);
    EXPECT_NEAR(uv.x, 1 - along, 1e-12);
    EXPECT_NEAR(uv.y, along, 1e-12);
  }
}

TEST(Formulas, aVirtualVertexLiesOnTheRayAtTheLengthOfThePath) {
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const dvec3 eye = 3.0 * randomDirection(random), onMirror = randomDirection(random),
                point = 2.0 * randomDirection(random);
    const dvec3 placed = formulas::placeBehind(eye, onMirror, point);
    EXPECT_NEAR(glm::distance(eye, placed), glm::distance(eye, onMirror) + glm::distance(onMirror, point),
                1e-12);
    EXPECT_NEAR(glm::length(glm::cross(placed - eye, onMirror - eye)), 0, 1e-12);
    const dvec3 normal = randomDirection(random);
    EXPECT_NEAR(glm::distance(formulas::mirrorInPlane(formulas::mirrorInPlane(point, onMirror, normal),
                                                      onMirror, normal),
                              point),
                0, 1e-12);
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
