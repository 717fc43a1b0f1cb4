// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/bezier_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "catoptric/geometry/mesh_inspection.h"
#include "catoptric/geometry/teapot.h"

namespace catoptric::geometry {
namespace {

/// The normal from finite differences of positions alone.
dvec3 differenceNormal(const BicubicPatch& patch, double u, double v) {
  constexpr double h = 1e-5;
  const dvec3 du = evaluatePatch(patch, u + h, v).position - evaluatePatch(patch, u - h, v).position;
  const dvec3 dv = evaluatePatch(patch, u, v + h).position - evaluatePatch(patch, u, v - h).position;
  return glm::normalize(glm::cross(du, dv));
}

TEST(BezierPatch, NormalsAgreeWithDifferencesOfPositions) {
  for (const BicubicPatch& patch : teapotPatches())
    for (double u : {0.15, 0.5, 0.8})
      for (double v : {0.2, 0.55, 0.9})
        ASSERT_GT(glm::dot(evaluatePatch(patch, u, v).normal, differenceNormal(patch, u, v)), 1 - 1e-6);
}

TEST(BezierPatch, CornersAreControlPoints) {
  const BicubicPatch& patch = teapotPatches()[3];
  EXPECT_LT(glm::distance(evaluatePatch(patch, 0, 0).position, patch.control[0]), 1e-12);
  EXPECT_LT(glm::distance(evaluatePatch(patch, 1, 0).position, patch.control[3]), 1e-12);
  EXPECT_LT(glm::distance(evaluatePatch(patch, 0, 1).position, patch.control[12]), 1e-12);
}

TEST(BezierPatch, DegenerateEdgesHaveTheLimitNormal) {
  // The top of the knob and the middle of the bottom are poles on the axis.
  int poles = 0;
  for (std::size_t i = 20; i < 32; ++i)
    for (double v : {0.0, 1.0}) {
      const BicubicPatch& patch = teapotPatches()[i];
      const dvec3 a = evaluatePatch(patch, 0, v).position, b = evaluatePatch(patch, 1, v).position;
      if (glm::distance(a, b) > 1e-9) continue;
      ++poles;
      for (double u : {0.0, 0.3, 1.0}) {
        const dvec3 n = evaluatePatch(patch, u, v).normal;
        EXPECT_NEAR(glm::length(n), 1, 1e-9);
        EXPECT_NEAR(n.z, i < 28 ? 1 : -1, 1e-3) << "patch " << i;
      }
    }
  EXPECT_EQ(poles, 8);
}

TEST(BezierPatch, TranslationalPatchIsStrictlyConvex) {
  const BicubicPatch patch = makeTranslationalPatch(
      {dvec3(-1, 0, -0.4), dvec3(-0.5, 0, 0.1), dvec3(0.4, 0, 0.2), dvec3(1, 0, -0.3)},
      {dvec3(0, -0.3, -0.2), dvec3(0, -0.1, 0), dvec3(0, 0.2, 0), dvec3(0, 0.3, -0.2)});
  const Mesh mesh = tessellatePatch(patch, 24, 24);
  EXPECT_GT(mesh.normals[300].z, 0.5f);
  EXPECT_EQ(findDeepestConcavity(mesh), 0);
  EXPECT_LT(findLargestNormalDeviation(mesh), 0.1);
  EXPECT_GT(findDeepestConcavity(tessellatePatch(patch, 24, 24, true)),
            1e-3);  // seen from behind it is concave
}

TEST(Teapot, PatchesMeetAlongTheirSharedEdges) {
  // Rim, body and bottom: neighbours around the axis share an edge, and the surface is smooth across it.
  const auto patches = teapotPatches();
  for (std::size_t first : {0u, 4u, 8u, 20u, 24u, 28u})
    for (std::size_t k = 0; k < 4; ++k) {
      const BicubicPatch &a = patches[first + k], &b = patches[first + (k + 1) % 4];
      for (double v : {0.1, 0.4, 0.75}) {
        PatchPoint right = evaluatePatch(a, 1, v), left = evaluatePatch(b, 0, v);
        if (glm::distance(right.position, left.position) >
            1e-9) {  // patches that were turned over run the other way
          right = evaluatePatch(a, 0, v);
          left = evaluatePatch(b, 1, v);
        }
        ASSERT_LT(glm::distance(right.position, left.position), 1e-9) << first + k << " v " << v;
        EXPECT_GT(glm::dot(right.normal, left.normal), std::cos(0.01)) << first + k << " v " << v;
      }
    }
}

TEST(Teapot, StandsOnTheTableWithItsFrontOutside) {
  const Mesh mesh = makeTeapot();
  const core::Box box = computeBounds(mesh);
  EXPECT_NEAR(box.lower.y, 0, 1e-6);
  EXPECT_NEAR(box.upper.y, 1, 1e-6);
  EXPECT_GT(box.upper.x, -box.lower.x);  // the spout reaches farther than the handle
  for (const vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5);
  // The lips of spout and lid bend sharply: the deviation must vanish with the size of the cells.
  EXPECT_LT(findLargestNormalDeviation(mesh), 1.35);
  EXPECT_LT(findLargestNormalDeviation(makeTeapot({.cellsPerPatch = 64, .withBottom = true})), 0.25);
  EXPECT_EQ(inspectEdges(mesh).inconsistent, 0u);
  EXPECT_GT(computeSignedVolume(mesh), 0.5);
  // The body is closed but for the handle's and the spout's ends and the gap under the lid.
  EXPECT_LT(inspectEdges(mesh).boundary, 200u);
}

TEST(Teapot, WithoutBottomHasFourPatchesLess) {
  const Mesh with = makeTeapot({.cellsPerPatch = 4, .withBottom = true});
  const Mesh without = makeTeapot({.cellsPerPatch = 4, .withBottom = false});
  EXPECT_EQ(with.triangleCount() - without.triangleCount(), 4u * (2 * 16 - 4));
}

}  // namespace
}  // namespace catoptric::geometry
