// SPDX-License-Identifier: Apache-2.0
// The solvers analytic, layered and subdivision against each other, against refined and against the closed
// form.
#include <gtest/gtest.h>

#include <cmath>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/virtual_object/analytic_finder.h"
#include "catoptric/virtual_object/extruded_reflector.h"
#include "catoptric/virtual_object/layered_finder.h"
#include "catoptric/virtual_object/reflection_subdivision.h"
#include "catoptric/virtual_object/special_reflector.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

constexpr double kFar = 6.0;

geometry::Mesh makeScreen() {  // the extrusion of a convex curve
  return geometry::makeHeightField(
      60, 8, [](dvec2 s) { return dvec2(0.5, 0.4) * s; },
      [](dvec2 p) {
        const double x2 = p.x * p.x;
        return geometry::HeightSample{-0.4 * x2 - 0.9 * x2 * x2, -0.8 * p.x - 3.6 * x2 * p.x, 0};
      });
}

geometry::ExtrusionFit profileOf(const geometry::Mesh& mesh) {
  return geometry::fitExtrusion({mesh.positions, mesh.normals, mesh.indices}).value();
}

/// A world of one mirror, recognised as the importer does.
scene::WorldGeometry makeWorld(const geometry::Mesh& mesh) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0;
  scene::MeshPrimitive primitive;
  primitive.positions = mesh.positions;
  primitive.normals = mesh.normals;
  primitive.indices = mesh.indices;
  primitive.material = 0;
  scene.meshes.emplace_back();
  scene.meshes[0].primitives.push_back(primitive);
  scene.instances.emplace_back();
  scene.instances[0].mesh = 0;
  return scene::makeWorldGeometry(scene);
}

std::vector<dvec3> randomPoints(int count, double nearest, double farthest, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<dvec3> points;
  points.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i)
    points.push_back(randomDirection(random) * (nearest + (farthest - nearest) * uniform(random)));
  return points;
}

TEST(ExtrudedReflector, HalvingFindsTheCellThatAskingAllFinds) {
  for (const bool isRing : {false, true}) {
    const geometry::Mesh mesh = isRing ? geometry::makeCylinderSide(0.5, 1, 90, 2, false) : makeScreen();
    ExtrudedReflector reflector(profileOf(mesh), isRing ? 0.0 : 0.2);
    for (const dvec3& eye : {dvec3(0.3, 0.2, 2), dvec3(1.6, -0.4, 0.5), dvec3(0.1, 0.6, 9)}) {
      reflector.setEye(eye);
      int found = 0;
      for (const dvec3& point : randomPoints(2000, 0.55, 4, 3)) {
        const dvec2 flat = reflector.project(point);
        const auto cell = reflector.locate(flat), byAll = reflector.locateByAll(flat);
        ASSERT_EQ(cell.has_value(), byAll.has_value());
        if (!cell) continue;
        EXPECT_LE(*cell > *byAll ? *cell - *byAll : *byAll - *cell, 1u);  // on a ray both are right
        ++found;
      }
      EXPECT_GT(found, 700);
    }
  }
}

TEST(ExtrudedReflector, ObeysTheMirrorLaw) {
  ExtrudedReflector reflector(profileOf(makeScreen()), 0.2);
  const dvec3 eye(0.3, 0.2, 2);
  reflector.setEye(eye);
  for (const dvec3& point : randomPoints(3000, 0.6, 4, 4)) {
    const auto found = reflector.find(point);
    if (!found) continue;
    const dvec3 half = glm::normalize(eye - found->position) + glm::normalize(point - found->position);
    EXPECT_LE(glm::length(glm::cross(glm::normalize(half), found->normal)), 1e-9);
    EXPECT_GT(glm::dot(found->normal, point - found->position), 0);
  }
}

TEST(Analytic, AgreesWithRefinedWhereThatIsExactToItsMesh) {
  const geometry::Mesh meshes[] = {geometry::makeIcosphere(0.5, 40),
                                   geometry::makeCylinderSide(0.4, 0.8, 360, 4, false), makeScreen(),
                                   geometry::makeRevolvedSide(0.8, 360, 4, [](double y) {
                                     return geometry::RadiusSample{0.5 - 0.4 * y, -0.4};
                                   })};
  for (const geometry::Mesh& mesh : meshes) {
    const scene::WorldGeometry world = makeWorld(mesh);
    ASSERT_EQ(world.reflectors.size(), 1u);
    ASSERT_EQ(findAnalyticObstacle(world.reflectors[0]), "");
    const ReflectorMesh reflectorMesh(world, 0);
    const dvec3 eye(0.5, 0.9, 2.6);
    VirtualObjectSolver solver(reflectorMesh, eye, kFar);
    solver.useFinder(makeAnalyticFinder(world, 0, false, 0.2));
    ASSERT_TRUE(solver.hasFinder());
    int reflected = 0;
    for (const dvec3& point : randomPoints(1500, 1.0, 4, 9)) {
      const auto a = solver.findReflectionPoint(Solver::Analytic, point),
                 r = solver.findReflectionPoint(Solver::Refined, point);
      if (!r || r->kind != VertexKind::Reflected) continue;
      if (glm::dot(r->normal, glm::normalize(eye - r->position)) < 0.1) continue;  // near the rim: facets
      ++reflected;
      ASSERT_TRUE(a);
      EXPECT_EQ(a->kind, VertexKind::Reflected);
      EXPECT_LE(a->residual, 1e-9);
      EXPECT_LT(glm::distance(a->position, r->position), 1e-3);
    }
    EXPECT_GT(reflected, 100);
  }
}

TEST(Analytic, SaysWhatItCannotServe) {
  const auto wave = geometry::makeHeightField(
      60, 4, [](dvec2 s) { return s; },
      [](dvec2 p) {
        return geometry::HeightSample{0.05 * std::cos(6 * p.x), -0.3 * std::sin(6 * p.x), 0};
      });
  const auto monkeySaddle = geometry::makeHeightField(
      20, 20, [](dvec2 s) { return s; },
      [](dvec2 p) {
        return geometry::HeightSample{0.2 * p.x * (p.x * p.x - 3 * p.y * p.y), 0.6 * (p.x * p.x - p.y * p.y),
                                      -1.2 * p.x * p.y};
      });
  for (const auto* mesh : {&wave, &monkeySaddle}) {
    const scene::WorldGeometry world = makeWorld(*mesh);
    EXPECT_NE(findAnalyticObstacle(world.reflectors.at(0)), "");
    EXPECT_EQ(makeAnalyticFinder(world, 0, false, 0.2), nullptr);
  }
  EXPECT_EQ(makeWorld(wave).reflectors[0].shape, scene::ReflectorShape::Extrusion);
}

TEST(Subdivision, TheHierarchyLosesNoCell) {
  for (const geometry::Mesh& mesh : {geometry::makeIcosphere(0.5, 12), makeScreen()}) {
    const ReflectorMesh mirror = meshOf(mesh);
    const dvec3 eye(0.5, 0.4, 1.8);
    ReflectedRays rays;
    computeReflectedRays(mirror, eye, rays);
    ReflectionSubdivision subdivision;
    subdivision.build(mirror, eye, rays);
    std::vector<CellPoint> quick, all;
    for (const dvec3& point : randomPoints(500, 0.55, 5, 21)) {
      subdivision.findReflectedCells(point, quick);
      subdivision.findReflectedCellsByAll(point, all);
      ASSERT_EQ(quick.size(), all.size());
      for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(quick[i].at.triangle, all[i].at.triangle);
    }
  }
}

TEST(Subdivision, OnAConvexMirrorEveryPointIsReflectedOnceOrHidden) {
  const ReflectorMesh mirror = meshOf(geometry::makeIcosphere(0.5, 12));
  const dvec3 eye(0.5, 0.4, 1.8);
  ReflectedRays rays;
  computeReflectedRays(mirror, eye, rays);
  ReflectionSubdivision subdivision;
  subdivision.build(mirror, eye, rays);
  std::vector<CellPoint> cells;
  int neither = 0, both = 0, hiddenCount = 0;
  const auto points = randomPoints(3000, 0.52, 5, 22);
  for (const dvec3& point : points) {
    subdivision.findReflectedCells(point, cells);
    const bool isHidden = subdivision.findHiddenCell(point).has_value();
    EXPECT_LE(cells.size(), 1u);
    neither += cells.empty() && !isHidden;
    both += !cells.empty() && isHidden;
    hiddenCount += isHidden;
  }
  EXPECT_GT(hiddenCount, 50);
  EXPECT_LE(neither + both, int(points.size()) / 100);  // slivers between facets at the rim
}

TEST(Subdivision, AgreesWithRefinedOnTriangleAndBarycentrics) {
  SolverOptions options;
  options.tolerance = 1e-12;
  options.newtonSteps = 40;
  for (const geometry::Mesh& mesh : {geometry::makeIcosphere(0.5, 16), makeScreen()}) {
    const ReflectorMesh mirror = meshOf(mesh);
    const dvec3 eye(0.5, 0.4, 1.8);
    VirtualObjectSolver solver(mirror, eye, kFar, options);
    solver.useFinder(std::make_unique<SubdivisionFinder>(mirror));
    int compared = 0;
    for (const dvec3& point : randomPoints(800, 0.6, 5, 23)) {
      const auto s = solver.findReflectionPoint(Solver::Subdivision, point),
                 r = solver.findReflectionPoint(Solver::Refined, point);
      if (!r || r->kind != VertexKind::Reflected) continue;
      ASSERT_TRUE(s);
      ++compared;
      EXPECT_LT(glm::distance(s->position, r->position), 1e-8);
      if (std::min({r->at.u, r->at.v, 1 - r->at.u - r->at.v}) < 1e-6) continue;  // on an edge
      EXPECT_EQ(s->at.triangle, r->at.triangle);
      EXPECT_NEAR(s->at.u, r->at.u, 1e-7);
      EXPECT_NEAR(s->at.v, r->at.v, 1e-7);
    }
    EXPECT_GT(compared, 150);
  }
}

TEST(Subdivision, AConcaveMirrorHasSeveralCellsAtOnePoint) {
  const auto bowl = geometry::makeHeightField(
      24, 24, [](dvec2 s) { return 0.5 * s; },
      [](dvec2 p) {
        const double root = std::sqrt(1 - glm::dot(p, p));
        return geometry::HeightSample{1 - root, p.x / root, p.y / root};
      });
  const ReflectorMesh mirror = meshOf(bowl, {.skirtWidth = 0});
  const dvec3 eye(0.05, 0.1, 3);
  ReflectedRays rays;
  computeReflectedRays(mirror, eye, rays);
  ReflectionSubdivision subdivision;
  subdivision.build(mirror, eye, rays);
  std::vector<CellPoint> cells;
  std::size_t most = 0;
  for (const dvec3& d : randomPoints(400, 0, 0.03, 5)) {
    subdivision.findReflectedCells(dvec3(0, 0, 0.58) + d, cells);
    most = std::max(most, cells.size());
  }
  EXPECT_GE(most, 3u);
}

}  // namespace
}  // namespace catoptric::virtual_object
