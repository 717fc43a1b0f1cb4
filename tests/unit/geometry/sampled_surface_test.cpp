// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/sampled_surface.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/mesh_inspection.h"

namespace catoptric::geometry {
namespace {

Mesh makeDish(double outline) {  // of a sphere of radius 2, hollow side up; outline 0: square, 1: disc
  const auto place = [=](dvec2 s) {
    const double length = glm::length(s), edge = std::max(std::abs(s.x), std::abs(s.y));
    return length > 0 ? glm::mix(s, s * (edge / length), outline) : s;
  };
  return makeHeightField(20, 20, place, [](dvec2 p) {
    const double root = std::sqrt(4 - glm::dot(p, p));
    return HeightSample{2 - root, p.x / root, p.y / root};
  });
}

TEST(HeightField, LiesOnItsSurfaceWithItsNormals) {
  for (const double outline : {0.0, 1.0}) {
    const Mesh mesh = makeDish(outline);
    ASSERT_EQ(mesh.triangleCount(), 800u);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const dvec3 toCentre = dvec3(0, 0, 2) - dvec3(mesh.positions[i]);
      EXPECT_NEAR(glm::length(toCentre), 2, 1e-6);
      EXPECT_NEAR(glm::dot(toCentre / 2.0, dvec3(mesh.normals[i])), 1, 1e-6);
    }
    const EdgeReport edges = inspectEdges(mesh);
    EXPECT_EQ(edges.nonManifold + edges.inconsistent, 0u);
    EXPECT_EQ(edges.boundary, 80u);
    EXPECT_LT(findLargestNormalDeviation(mesh), 0.06);  // no sliver at the corners of a round outline either
  }
}

TEST(RevolvedSide, ClosesAroundAndFacesOutwards) {
  const Mesh mesh = makeRevolvedSide(2, 64, 10, [](double y) { return RadiusSample{1 + 0.5 * y, 0.5}; });
  const EdgeReport edges = inspectEdges(mesh);
  EXPECT_EQ(edges.boundary, 2u * 64u);
  EXPECT_EQ(edges.nonManifold + edges.inconsistent, 0u);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p(mesh.positions[i]), n(mesh.normals[i]);
    EXPECT_NEAR(glm::length(dvec2(p.x, p.z)), 1 + 0.5 * p.y, 1e-6);
    EXPECT_GT(glm::dot(n, dvec3(p.x, 0, p.z)), 0);
    EXPECT_NEAR(n.y / glm::length(dvec2(n.x, n.z)), -0.5, 1e-6);
  }
  EXPECT_LT(findLargestNormalDeviation(mesh), 0.06);
}

}  // namespace
}  // namespace catoptric::geometry
