// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/shape_recognition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "catoptric/geometry/mesh_measures.h"
#include "catoptric/geometry/vertex_weld.h"

namespace catoptric::geometry {
namespace {

struct TestMesh {
  std::vector<vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  [[nodiscard]] MeshView view() const { return {positions, normals, indices}; }
};

/// Grid over u, v in 0..1; `surface` gives position and normal, counter-clockwise where du x dv is the front.
TestMesh makeGrid(int n, const std::function<std::pair<dvec3, dvec3>(double, double)>& surface) {
  TestMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const auto [p, normal] = surface(double(i) / n, double(j) / n);
      mesh.positions.push_back(vec3(p));
      mesh.normals.push_back(vec3(glm::normalize(normal)));
    }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

const dvec3 kCentre(3, -2, 7);
const dvec3 kAxis = glm::normalize(dvec3(1, 2, -0.5));
const dvec3 kAcross = glm::normalize(glm::cross(kAxis, dvec3(0, 0, 1)));
const dvec3 kThird = glm::cross(kAxis, kAcross);

dvec3 around(double angle) {
  return std::cos(angle) * kAcross + std::sin(angle) * kThird;
}

/// A third of a turn, so that the fits cannot lean on symmetry.
TestMesh makeCylinderPatch(double radius) {
  return makeGrid(24, [=](double u, double v) {
    const dvec3 r = around(2.1 * u);
    return std::pair(kCentre + radius * r + 3.0 * v * kAxis, r);
  });
}

TestMesh makeConePatch(double halfAngle) {
  return makeGrid(24, [=](double u, double v) {
    const dvec3 r = around(2.1 * u);
    const double along = 1 + 2 * v;
    return std::pair(kCentre + along * (kAxis + std::tan(halfAngle) * r),
                     std::cos(halfAngle) * r - std::sin(halfAngle) * kAxis);
  });
}

TestMesh makeSpherePatch(double radius, bool inside = false) {
  return makeGrid(24, [=](double u, double v) {
    const dvec3 d = glm::normalize(kAxis + 1.2 * (u - 0.5) * kAcross + 1.2 * (v - 0.5) * kThird);
    return std::pair(kCentre + radius * d, inside ? -d : d);
  });
}

TEST(ShapeRecognition, PlaneFacesByWinding) {
  const TestMesh mesh = makeGrid(
      5, [](double u, double v) { return std::pair(kCentre + 4 * u * kAcross + 2 * v * kThird, -kAxis); });
  const auto fit = fitPlane(mesh.view());
  ASSERT_TRUE(fit);
  const dvec3 front = glm::cross(kAcross, kThird);
  EXPECT_LT(glm::length(fit->plane.normal - front), 1e-6);
  EXPECT_NEAR(fit->plane.signedDistance(kCentre), 0, 1e-6);
  EXPECT_LT(fit->deviation.distance, 2e-6);
  EXPECT_LT(fit->deviation.angleRadians, 1e-6);  // normals that face the other way are the same plane
}

TEST(ShapeRecognition, DeviationsAreMeasured) {
  TestMesh mesh = makeGrid(10, [](double u, double v) { return std::pair(dvec3(u, v, 0), dvec3(0, 0, 1)); });
  mesh.positions[60].z = 0.01f;
  mesh.normals[17] = vec3(glm::normalize(dvec3(0.05, 0, 1)));
  const auto fit = fitPlane(mesh.view());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->deviation.distance, 0.01, 1e-3);
  EXPECT_NEAR(fit->deviation.angleRadians, 0.05, 1e-3);
}

TEST(ShapeRecognition, Sphere) {
  for (const bool inside : {false, true}) {
    const TestMesh mesh = makeSpherePatch(2.5, inside);
    const auto fit = fitSphere(mesh.view());
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->radius, 2.5, 1e-5);
    EXPECT_LT(glm::length(fit->centre - kCentre), 1e-5);
    EXPECT_EQ(fit->isInside, inside);
    EXPECT_LT(fit->deviation.distance, 2e-6);
    EXPECT_LT(fit->deviation.angleRadians, 1e-5);
  }
}

TEST(ShapeRecognition, SphereUnderNoiseIsTheLeastSquaresOne) {
  TestMesh mesh = makeSpherePatch(2.5);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.005);
  for (vec3& p : mesh.positions) p += vec3(noise(random) * glm::normalize(dvec3(p) - kCentre));
  const auto fit = fitSphere(mesh.view());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->radius, 2.5, 0.02);
  EXPECT_LT(fit->deviation.distance, 0.03);
  EXPECT_GT(fit->deviation.distance, 0.005);
}

TEST(ShapeRecognition, Cylinder) {
  const TestMesh mesh = makeCylinderPatch(1.5);
  const auto fit = fitCylinder(mesh.view());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->radius, 1.5, 1e-5);
  EXPECT_LT(glm::length(glm::cross(fit->axis, kAxis)), 1e-5);
  EXPECT_LT(glm::length(glm::cross(fit->point - kCentre, kAxis)), 1e-4);
  EXPECT_FALSE(fit->isInside);
  EXPECT_LT(fit->deviation.distance, 1e-5);
  EXPECT_LT(fit->deviation.angleRadians, 1e-5);
}

TEST(ShapeRecognition, Cone) {
  const TestMesh mesh = makeConePatch(0.4);
  const auto fit = fitCone(mesh.view());
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->halfAngleRadians, 0.4, 1e-5);
  EXPECT_LT(glm::length(fit->axis - kAxis), 1e-5);
  EXPECT_LT(glm::length(fit->apex - kCentre), 1e-4);
  EXPECT_LT(fit->deviation.distance, 1e-5);
}

TEST(ShapeRecognition, ShapesAreToldApart) {
  EXPECT_GT(fitSphere(makeCylinderPatch(1.5).view())->deviation.distance, 0.05);
  EXPECT_GT(fitCylinder(makeConePatch(0.4).view())->deviation.distance, 0.05);
  const auto cone = fitCone(makeSpherePatch(2.5).view());
  EXPECT_TRUE(!cone || cone->deviation.distance > 0.05);
  EXPECT_GT(fitPlane(makeSpherePatch(2.5).view())->deviation.distance, 0.05);
}

TEST(ShapeRecognition, NothingFitsWhereTheSystemIsSingular) {
  const TestMesh flat =
      makeGrid(5, [](double u, double v) { return std::pair(dvec3(u, v, 0), dvec3(0, 0, 1)); });
  EXPECT_FALSE(fitSphere(flat.view()));
  EXPECT_FALSE(fitCylinder(flat.view()));
  EXPECT_FALSE(fitCone(flat.view()));
  const TestMesh nothing;
  EXPECT_FALSE(fitPlane(nothing.view()));
  EXPECT_FALSE(fitSphere(nothing.view()));
  // Both sides of one sheet: no front.
  TestMesh folded = flat;
  for (std::size_t i = 0; i < flat.indices.size(); i += 3)
    folded.indices.insert(folded.indices.end(), {flat.indices[i], flat.indices[i + 2], flat.indices[i + 1]});
  EXPECT_FALSE(fitPlane(folded.view()));
}

TEST(MeshMeasures, ConvexityOfPatches) {
  const auto flipped = [](TestMesh mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    return mesh;
  };
  // Grids of makeSpherePatch: kAcross x kThird = kAxis is outwards, so the front is the outside.
  EXPECT_TRUE(isConvexMesh(makeSpherePatch(2.5).view()));
  EXPECT_FALSE(isConvexMesh(flipped(makeSpherePatch(2.5)).view()));
  const TestMesh flat =
      makeGrid(5, [](double u, double v) { return std::pair(dvec3(u, v, 0), dvec3(0, 0, 1)); });
  EXPECT_TRUE(isConvexMesh(flat.view()));
  // Two flat sheets that bend towards the front by 0.01 rad are not; towards the back they are.
  for (const double bend : {0.01, -0.01}) {
    const TestMesh sheet = makeGrid(6, [=](double u, double v) {
      return std::pair(dvec3(u, v, bend * std::max(u - 0.5, 0.0)), dvec3(0, 0, 1));
    });
    EXPECT_EQ(isConvexMesh(sheet.view()), bend < 0);
  }
  EXPECT_FALSE(isConvexMesh(TestMesh{}.view()));
}

TEST(MeshMeasures, LocallyConvexButWoundUpIsNotConvex) {
  // A spiral sheet: convex at every edge, but its outer turns stand before its inner ones.
  const TestMesh spiral = makeGrid(80, [](double u, double v) {
    const double angle = 12 * u, r = 1 + 0.2 * u;
    return std::pair(dvec3(r * std::cos(angle), r * std::sin(angle), 2 * v),
                     dvec3(std::cos(angle), std::sin(angle), 0));
  });
  EXPECT_FALSE(isConvexMesh(spiral.view()));
}

TEST(MeshMeasures, BoundingSphereHoldsEverythingAndIsTight) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<vec3> points(2000);
  for (vec3& p : points) {
    do p = {uniform(random), uniform(random), uniform(random)};
    while (glm::dot(p, p) > 1);
    p = p * 5.0f + vec3(1, 2, 3);
  }
  const BoundingSphere sphere = computeBoundingSphere(points);
  for (const vec3& p : points) EXPECT_LE(glm::length(dvec3(p) - sphere.centre), sphere.radius * (1 + 1e-12));
  EXPECT_LT(sphere.radius, 5.2);
  EXPECT_EQ(computeBoundingSphere({}).radius, 0);
  EXPECT_EQ(computeBoundingSphere(std::vector<vec3>{vec3(4)}).radius, 0);
}

TEST(VertexWeld, JoinsAcrossCellBordersAndKeepsOthersApart) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-10, 10), jitter(-1, 1);
  const double tolerance = 1e-4;
  std::vector<vec3> positions;
  for (int i = 0; i < 3000; ++i) {
    const dvec3 p(uniform(random), uniform(random), uniform(random));
    positions.push_back(vec3(p));
    positions.push_back(vec3(p + 0.4 * tolerance * dvec3(jitter(random), jitter(random), jitter(random))));
    positions.push_back(vec3(p + dvec3(5 * tolerance, 0, 0)));
  }
  const auto welded = weldVertices(positions, {}, {.positionTolerance = tolerance});
  for (std::uint32_t i = 0; i < positions.size(); i += 3) {
    EXPECT_EQ(welded[i], i);
    EXPECT_EQ(welded[i + 1], i);
    EXPECT_EQ(welded[i + 2], i + 2);
  }
}

TEST(VertexWeld, NormalsSeparateFacets) {
  const std::vector<vec3> positions(4, vec3(1, 2, 3)),
      normals{vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, 1), vec3(5e-5f, 0, 1)};
  const auto welded = weldVertices(positions, normals, {});
  EXPECT_EQ(welded, (std::vector<std::uint32_t>{0, 1, 0, 0}));
}

TEST(VertexWeld, ManyNormalsAtOnePointStayFast) {
  // The apex of a fine cone: quadratic work would take minutes here.
  std::vector<vec3> positions(200000, vec3(0)), normals;
  for (int i = 0; i < 200000; ++i) {
    const double a = 6.283185307 * i / 200000;
    normals.push_back(vec3(glm::normalize(dvec3(std::cos(a), 0.5, std::sin(a)))));
  }
  EXPECT_EQ(weldVertices(positions, normals, {}).size(), positions.size());
}

}  // namespace
}  // namespace catoptric::geometry
