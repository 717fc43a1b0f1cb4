// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "catoptric/geometry/mesh_inspection.h"
#include "catoptric/geometry/polyhedra.h"
#include "catoptric/geometry/sweep.h"

namespace catoptric::geometry {
namespace {

constexpr double kPi = 3.141592653589793;

void expectUnitNormals(const Mesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
  for (const vec3& n : mesh.normals) ASSERT_NEAR(glm::length(dvec3(n)), 1.0, 1e-6);
  for (std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
}

TEST(Icosphere, IsWatertightConvexAndExact) {
  const int frequency = 12;
  const Mesh mesh = makeIcosphere(0.5, frequency);
  expectUnitNormals(mesh);
  EXPECT_EQ(mesh.triangleCount(), 20u * frequency * frequency);
  EXPECT_EQ(mesh.positions.size(), 10u * frequency * frequency + 2);  // Euler: nothing is stored twice
  EXPECT_TRUE(inspectEdges(mesh).isWatertight());
  EXPECT_EQ(findDeepestConcavity(mesh), 0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_LT(glm::distance(dvec3(mesh.positions[i]), 0.5 * dvec3(mesh.normals[i])), 1e-7);
  const double volume = 4.0 / 3 * kPi * 0.125;
  EXPECT_NEAR(computeSignedVolume(mesh), volume, 0.01 * volume);
  EXPECT_GT(findSmallestCorner(mesh), 0.75);  // 43 degrees: no slivers
}

TEST(Icosphere, ConcavityIsFoundWhenAVertexIsPushedIn) {
  Mesh mesh = makeIcosphere(0.5, 6);
  mesh.positions[17] *= 0.9f;
  EXPECT_GT(findDeepestConcavity(mesh), 0.01);
}

TEST(UvSphere, IsWatertightWithTheSeamClosed) {
  const Mesh mesh = makeUvSphere(1.0, 32, 16);
  expectUnitNormals(mesh);
  EXPECT_TRUE(inspectEdges(mesh).isWatertight());
  EXPECT_GT(computeSignedVolume(mesh), 4.0);
  EXPECT_LT(findLargestNormalDeviation(mesh), 0.21);
}

TEST(Cylinder, SideSharesItsVerticesAndFacesOut) {
  const Mesh side = makeCylinderSide(0.4, 2.0, 64, 4, false);
  expectUnitNormals(side);
  EXPECT_EQ(side.positions.size(), 64u * 5);
  EXPECT_EQ(findDeepestConcavity(side), 0);
  EXPECT_EQ(inspectEdges(side).boundary, 128u);
  EXPECT_LT(findLargestNormalDeviation(side), 1.01 * kPi / 64);
}

TEST(Solids, AreClosedAndRightSideOut) {
  const std::vector<dvec2> bottle = {{0, 0}, {0.4, 0}, {0.4, 0.8}, {0.1, 1.0}, {0.1, 1.2}, {0, 1.2}};
  const std::vector<dvec2> letterL = {{0, 0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.3, 1}, {0, 1}};
  const struct {
    const char* name;
    Mesh mesh;
    double volume, tolerance;
  } solids[] = {
      {"cylinder", makeCylinder(0.5, 2, 256), kPi * 0.5, 1e-3},
      {"cone", makeCone(0.5, 0, 1.5, 256, true), kPi * 0.125, 1e-3},
      {"frustum", makeCone(0.5, 0.25, 1, 256, true), kPi / 3 * (0.25 + 0.125 + 0.0625), 1e-3},
      {"box", makeBox({1, 2, 3}), 6, 1e-9},
      {"metric box", makeBoxMetric({1, 2, 3}, 0.5), 6, 1e-9},
      {"torus", makeTorus(1, 0.25, 256, 128), 2 * kPi * kPi / 16, 1e-3},
      {"rod", makeRod({1, 2, 3}, {2, 4, 5}, 0.1, 256), kPi * 0.01 * 3, 1e-3},
      {"extrusion", makeExtrusion(letterL, 2.0), 2 * 0.51, 1e-6},
      {"smooth extrusion", makeExtrusion(letterL, 2.0, 2.0), 2 * 0.51, 1e-6},
      {"lathe", makeLathe(bottle, 256), kPi * (0.128 + 0.2 / 3 * 0.21 + 0.002), 2e-3},
      {"tetrahedron", makePolyhedron(Polyhedron::Tetrahedron, 1), 8 * std::sqrt(3.0) / 27, 1e-6},
      {"cube", makePolyhedron(Polyhedron::Cube, std::sqrt(3.0)), 8, 1e-6},
      {"octahedron", makePolyhedron(Polyhedron::Octahedron, 1), 4.0 / 3, 1e-6},
      {"dodecahedron", makePolyhedron(Polyhedron::Dodecahedron, 1), 2.785163863, 1e-6},
      {"icosahedron", makePolyhedron(Polyhedron::Icosahedron, 1), 2.536150710, 1e-6},
  };
  for (const auto& solid : solids) {
    SCOPED_TRACE(solid.name);
    expectUnitNormals(solid.mesh);
    const EdgeReport edges = inspectEdges(solid.mesh);
    EXPECT_EQ(edges.boundary, 0u);
    EXPECT_EQ(edges.inconsistent, 0u);
    EXPECT_EQ(edges.nonManifold, 0u);
    EXPECT_NEAR(computeSignedVolume(solid.mesh), solid.volume, solid.tolerance * solid.volume + 1e-6);
    EXPECT_LT(findLargestNormalDeviation(solid.mesh), 1.1);
  }
}

TEST(Polyhedra, FacetsAreFlatAndCounted) {
  const struct {
    Polyhedron kind;
    std::size_t facets, cornersPerFacet;
  } cases[] = {{Polyhedron::Tetrahedron, 4, 3},
               {Polyhedron::Cube, 6, 4},
               {Polyhedron::Octahedron, 8, 3},
               {Polyhedron::Dodecahedron, 12, 5},
               {Polyhedron::Icosahedron, 20, 3}};
  for (const auto& c : cases) {
    const Mesh mesh = makePolyhedron(c.kind, 0.3);
    EXPECT_EQ(mesh.positions.size(), c.facets * c.cornersPerFacet);
    EXPECT_EQ(mesh.triangleCount(), c.facets * (c.cornersPerFacet - 2));
    EXPECT_LT(findLargestNormalDeviation(mesh), 1e-5);
    EXPECT_EQ(findDeepestConcavity(mesh), 0);
  }
}

TEST(Plane, FacesUpWithTextureFromItsFarLeftCorner) {
  const Mesh mesh = makePlane(2, 4, 3, 5);
  EXPECT_EQ(mesh.triangleCount(), 30u);
  EXPECT_LT(findLargestNormalDeviation(mesh), 1e-9);
  EXPECT_EQ(mesh.normals[0], vec3(0, 1, 0));
  EXPECT_EQ(mesh.uv[0], vec2(0, 0));
  EXPECT_EQ(mesh.positions[0], vec3(-1, 0, -2));
}

TEST(Transform, MirroringKeepsTheFrontOutside) {
  const Mesh box = makeBox({1, 1, 1});
  const Mesh mirrored = transformed(box, scaleBy({-2, 1, 1}));
  EXPECT_NEAR(computeSignedVolume(mirrored), 2, 1e-6);
  EXPECT_LT(findLargestNormalDeviation(mirrored), 1e-6);
  EXPECT_NEAR(computeSignedVolume(flipped(box)), -1, 1e-6);
}

TEST(SmoothNormals, CreaseAngleDecidesWhatIsSmooth) {
  const Mesh box = makeBox({1, 1, 1});
  EXPECT_EQ(withSmoothNormals(box, 1.0).positions.size(), 24u);
  const Mesh round = welded(withSmoothNormals(box, 2.0), 1e-6, 1e-4);
  EXPECT_EQ(round.positions.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(glm::dot(glm::normalize(dvec3(round.positions[i])), dvec3(round.normals[i])), 1.0, 1e-6);
}

TEST(Append, FillsAttributesThatOneSideLacks) {
  Mesh sum = makeIcosphere(1, 1);
  const std::size_t before = sum.positions.size();
  append(sum, makeBox({1, 1, 1}));
  ASSERT_EQ(sum.uv.size(), sum.positions.size());
  EXPECT_EQ(sum.uv[before - 1], vec2(0));
  EXPECT_EQ(sum.triangleCount(), 32u);
}

}  // namespace
}  // namespace catoptric::geometry
