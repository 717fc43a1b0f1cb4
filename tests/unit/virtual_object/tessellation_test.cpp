// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/tessellation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "catoptric/core/log.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/raster/virtual_triangles.h"
#include "reflection_harness.h"

namespace catoptric::virtual_object {

using namespace raster;

namespace {

using test::TestWorld;

TestWorld makeWorld() {
  TestWorld world(geometry::transformed(geometry::makeIcosphere(0.5, 8), geometry::moveBy({0, 0.5, 0})));
  world.add(geometry::makeQuad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}), true);
  world.add(geometry::transformed(geometry::makeBox({1, 1, 1}), geometry::moveBy({-1.5, 0.7, 0})), false);
  world.add(geometry::transformed(geometry::makeIcosphere(0.3, 3), geometry::moveBy({1, 0.3, 1})), false);
  return world;
}

double areaOf(const std::vector<vec3>& positions, const std::uint32_t* c) {
  const dvec3 a(positions[c[0]]), b(positions[c[1]]), d(positions[c[2]]);
  return 0.5 * glm::length(glm::cross(b - a, d - a));
}

TEST(Tessellation, keepsAreaSourcesAndParts) {
  const TestWorld world = makeWorld();
  const scene::WorldGeometry& g = world.geometry();
  const TessellatedObjects objects = tessellateForReflector(g, 0);
  std::map<std::uint32_t, double> areas;
  for (std::size_t t = 0; t < objects.indices.size() / 3; ++t)
    areas[objects.sourceTriangles[t]] += areaOf(objects.positions, &objects.indices[3 * t]);
  for (const auto& [source, area] : areas) {
    EXPECT_NEAR(area, areaOf(g.positions, &g.indices[3 * source]), 1e-4);
    EXPECT_NE(g.parts[g.triangleParts[source]].reflector, 0u);  // never the mirror itself
  }
  EXPECT_EQ(areas.size(), g.triangleCount() - g.parts[0].indexCount / 3);
  ASSERT_EQ(objects.parts.size(), g.parts.size() - 1);
  std::uint32_t nextIndex = 0;
  for (std::size_t i = 0; i < objects.parts.size(); ++i) {
    const TessellatedPart& p = objects.parts[i];
    EXPECT_EQ(p.part, i + 1);
    EXPECT_EQ(p.firstIndex, nextIndex);
    nextIndex += p.indexCount;
    for (std::uint32_t k = p.firstIndex; k < p.firstIndex + p.indexCount; ++k) {
      EXPECT_GE(objects.indices[k], p.firstVertex);
      EXPECT_LT(objects.indices[k], p.firstVertex + p.vertexCount);
    }
  }
}

/// Every edge has its reverse, or lies on the outline of the world's own open edges: compared by exact
/// positions.
TEST(Tessellation, isEstimatedWithoutBeingMade) {
  const TestWorld world = makeWorld();
  for (const double error : {0.1, 0.5, 4.0, 100.0}) {
    const TessellationOptions options{.maxErrorPx = error};
    const double made = double(tessellateForReflector(world.geometry(), 0, options).indices.size()) / 3;
    const double expected = double(estimateTriangles(world.geometry(), 0, options));
    EXPECT_GT(expected, made / 1.7) << error;
    EXPECT_LT(expected, made * 1.7) << error;
  }
}

TEST(Tessellation, hasNoCracksEvenBetweenDuplicatedVertices) {
  const TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  const auto key = [&](std::uint32_t v) {
    std::array<std::uint32_t, 3> bits;
    std::memcpy(bits.data(), &objects.positions[v], 12);
    return bits;
  };
  for (const TessellatedPart& part : objects.parts) {
    if (world.geometry().parts[part.part].shell) continue;  // the floor is an open quad
    std::map<std::pair<std::array<std::uint32_t, 3>, std::array<std::uint32_t, 3>>, int> edges;
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
      for (int k = 0; k < 3; ++k) {
        const auto a = key(objects.indices[i + k]), b = key(objects.indices[i + (k + 1) % 3]);
        if (a < b)
          ++edges[{a, b}];
        else
          --edges[{b, a}];
      }
    for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
  }
}

TEST(Tessellation, leavesOutWhatLiesBehindAnOpenMirror) {
  // Faces up; one box above, one below, one across.
  TestWorld world(geometry::makePlane(1, 1, 4, 4));
  for (const double y : {2.0, -2.0, 0.0})
    world.add(geometry::transformed(geometry::makeBox({1, 1, 1}), geometry::moveBy({0, y, 0})), false);
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  std::map<std::uint32_t, double> areas;
  for (const TessellatedPart& part : objects.parts)
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
      areas[part.part] += areaOf(objects.positions, &objects.indices[i]);
  EXPECT_NEAR(areas[1], 6.0, 1e-4);
  EXPECT_EQ(areas.count(2), 0u);
  EXPECT_GT(areas[3], 3.0);  // the upper half, and what is cut too coarsely to be left out
  EXPECT_LT(areas[3], 5.5);
}

TEST(Tessellation, keepsWhatLiesBehindAnOpenMirrorForFlatOnesBehindIt) {
  TestWorld world(geometry::makePlane(1, 1, 4, 4));
  world.add(geometry::transformed(geometry::makeBox({1, 1, 1}), geometry::moveBy({0, -2, 0})), false);
  EXPECT_TRUE(tessellateForReflector(world.geometry(), 0).parts.empty());
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0, {.keepsBehind = true});
  double area = 0;
  for (std::size_t i = 0; i < objects.indices.size(); i += 3)
    area += areaOf(objects.positions, &objects.indices[i]);
  EXPECT_NEAR(area, 6.0, 1e-4);
}

TEST(Tessellation, isFineNearTheMirrorAndCoarseAway) {
  const TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  double longestNear = 0, longestFar = 0;
  for (std::size_t i = 0; i < objects.indices.size(); i += 3)
    for (int k = 0; k < 3; ++k) {
      const dvec3 a(objects.positions[objects.indices[i + k]]),
          b(objects.positions[objects.indices[i + (k + 1) % 3]]);
      const double d = glm::length(0.5 * (a + b) - dvec3(0, 0.5, 0)) - 0.5;
      (d < 0.2 ? longestNear : longestFar) = std::max(d < 0.2 ? longestNear : longestFar, glm::length(b - a));
    }
  EXPECT_LE(longestNear, objects.edgeFactor * (0.2 + 0.27));  // focal length 0.25
  EXPECT_GE(longestFar, 2 * longestNear);
}

TEST(Tessellation, leavesEverythingAsItIsWhereAnyErrorWillDo) {
  const TestWorld world = makeWorld();
  const scene::WorldGeometry& g = world.geometry();
  const std::size_t own = g.parts[0].indexCount;
  EXPECT_EQ(tessellateForReflector(g, 0, {.maxErrorPx = kUncutPx}).indices.size(), g.indices.size() - own);
  EXPECT_GT(tessellateForReflector(g, 0, {.maxErrorPx = 0.9 * kUncutPx}).indices.size(),
            g.indices.size() - own);
}

TEST(Tessellation, attributesAreMeansAndNormalsAreNotRenormalised) {
  const TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  const scene::WorldGeometry& g = world.geometry();
  int shorter = 0;
  for (std::size_t t = 0; t < objects.indices.size() / 3; t += 7) {
    const std::uint32_t* source = &g.indices[3 * objects.sourceTriangles[t]];
    const dvec3 a(g.positions[source[0]]), e1 = dvec3(g.positions[source[1]]) - a,
                                           e2 = dvec3(g.positions[source[2]]) - a;
    const dvec3 n = glm::cross(e1, e2);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = objects.indices[3 * t + k];
      const dvec3 p = dvec3(objects.positions[v]) - a;
      const double u = glm::dot(glm::cross(p, e2), n) / glm::dot(n, n),
                   w = glm::dot(glm::cross(e1, p), n) / glm::dot(n, n);
      const dvec3 expected = dvec3(g.normals[source[0]]) * (1 - u - w) + dvec3(g.normals[source[1]]) * u +
                             dvec3(g.normals[source[2]]) * w;
      EXPECT_NEAR(glm::length(expected - dvec3(objects.normals[v])), 0, 1e-4);
      shorter += glm::length(objects.normals[v]) < 0.9999f;
    }
  }
  EXPECT_GT(shorter, 0);
}

TEST(Tessellation, keepsToItsBudgetAndSaysSo) {
  std::string warning;
  core::setLogCallback([&](core::LogLevel level, const std::string& line) {
    if (level == core::LogLevel::Warning) warning = line;
  });
  const TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0, {.maxTriangles = 3000});
  core::setLogCallback({});
  EXPECT_LE(objects.indices.size() / 3, 3000u);
  EXPECT_NE(warning.find("mirror"), std::string::npos) << warning;
  EXPECT_GT(objects.edgeFactor, tessellateForReflector(world.geometry(), 0).edgeFactor);
}

TEST(Tessellation, isDeterministic) {
  const TestWorld world = makeWorld();
  const TessellatedObjects a = tessellateForReflector(world.geometry(), 0),
                           b = tessellateForReflector(world.geometry(), 0);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(vec3)), 0);
}

TEST(Selection, dropsWhatCannotBeSeenAndKeepsPartRuns) {
  const TestWorld world = makeWorld();
  const TessellatedObjects objects = tessellateForReflector(world.geometry(), 0);
  const std::size_t n = objects.positions.size();
  const dvec3 eye(0, 1, 4);
  std::vector<VertexKind> kinds(n, VertexKind::Reflected);
  VirtualTriangles out;
  // A planar mirror at z = 0 for all: everything is kept.
  std::vector<vec3> mirrored(n), points(n);
  for (std::size_t i = 0; i < n; ++i) {
    const vec3 p = objects.positions[i];
    mirrored[i] = vec3(p.x, p.y, -10 - p.z);
    points[i] = vec3(p.x, p.y + 50, -5);  // well above, so that every face has a side
  }
  selectVirtualTriangles(objects, eye, mirrored, kinds, points, out);
  ASSERT_EQ(out.parts.size(), objects.parts.size());
  std::size_t kept = 0;
  for (const TessellatedPart& part : out.parts) kept += part.indexCount / 3;
  EXPECT_EQ(kept, out.indices.size() / 3);
  const std::size_t all = kept;
  // One None vertex takes its triangles with it; a whole part of doubly virtual vertices vanishes.
  kinds[objects.indices[0]] = VertexKind::None;
  selectVirtualTriangles(objects, eye, mirrored, kinds, points, out);
  EXPECT_LT(out.indices.size() / 3, all);
  std::fill(kinds.begin(), kinds.end(), VertexKind::DoublyVirtual);
  selectVirtualTriangles(objects, eye, mirrored, kinds, points, out);
  EXPECT_EQ(out.indices.size(), 0u);
  EXPECT_EQ(out.parts.size(), objects.parts.size());
}

TEST(Selection, dropsPartlyHiddenTrianglesAlongALongChord) {
  // A strip behind a sphere, from one side of its shadow to the other: two corners are seen at the rim, far
  // from each other, the third is hidden.
  TestWorld world(geometry::makeIcosphere(0.5, 12));
  geometry::Mesh strip;
  strip.positions = {{-1.8f, 0.2f, -6}, {1.8f, 0.2f, -6}, {0, 0.25f, -6}};
  strip.normals.assign(3, vec3(0, 0, 1));
  strip.indices = {0, 1, 2};
  world.add(strip, false);
  const dvec3 eye(0, 0, 3);
  const ReflectorMesh mesh(world.geometry(), 0);
  const VirtualObjectSolver solver(mesh, eye, 8.0);
  const TessellatedObjects uncut =
      tessellateForReflector(world.geometry(), 0, {.maxErrorPx = 1e9, .maxTriangles = 1});
  std::vector<vec3> out(3), points(3);
  std::vector<VertexKind> kinds(3);
  solver.compute(Solver::Refined, uncut.positions, out, kinds, points);
  ASSERT_EQ(std::count(kinds.begin(), kinds.end(), VertexKind::DoublyVirtual), 1);
  ASSERT_EQ(std::count(kinds.begin(), kinds.end(), VertexKind::Reflected), 2);
  VirtualTriangles triangles;
  markVirtualTriangles(uncut, eye, out, kinds, points, triangles, {}, {.atRim = 0.1f});
  EXPECT_EQ(triangles.isKept[0], 0);
  // However long the chord is, of one whose corners are all reflected orientation decides.
  std::fill(kinds.begin(), kinds.end(), VertexKind::Reflected);
  VirtualTriangles all, some;
  markVirtualTriangles(uncut, eye, out, kinds, points, all);
  markVirtualTriangles(uncut, eye, out, kinds, points, some, {}, {.atRim = 0.1f});
  EXPECT_EQ(all.isKept, some.isKept);
}

TEST(Selection, dropsTrianglesThatReachAroundTheShadow) {
  // A big triangle behind a sphere, its corners all around the shadow: its image must not cover the mirror.
  TestWorld world(geometry::makeIcosphere(0.5, 12));
  geometry::Mesh big;
  big.positions = {{-2, -1.5f, -6}, {2, -1.5f, -6}, {0, 2.5f, -6}};
  big.normals.assign(3, vec3(0, 0, 1));
  big.indices = {0, 1, 2};
  world.add(big, false);
  const dvec3 eye(0, 0, 3);
  const ReflectorMesh mesh(world.geometry(), 0);
  const VirtualObjectSolver solver(mesh, eye, 8.0);
  TessellatedObjects uncut =
      tessellateForReflector(world.geometry(), 0, {.maxErrorPx = 1e9, .maxTriangles = 1});
  ASSERT_EQ(uncut.indices.size(), 3u);
  std::vector<vec3> out(3), points(3);
  std::vector<VertexKind> kinds(3);
  solver.compute(Solver::Refined, uncut.positions, out, kinds, points);
  for (const VertexKind kind : kinds) ASSERT_EQ(kind, VertexKind::Reflected);
  VirtualTriangles triangles;
  selectVirtualTriangles(uncut, eye, out, kinds, points, triangles);
  EXPECT_EQ(triangles.indices.size(), 0u);
  // The same triangle on the viewer's side is an honest one.
  for (vec3& p : uncut.positions) p.z = 6;
  solver.compute(Solver::Refined, uncut.positions, out, kinds, points);
  selectVirtualTriangles(uncut, eye, out, kinds, points, triangles);
  EXPECT_EQ(triangles.indices.size(), 3u);
}

}  // namespace
}  // namespace catoptric::virtual_object
