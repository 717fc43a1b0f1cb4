// SPDX-License-Identifier: Apache-2.0
// Solvers on input that nothing can be made of, or nearly nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

using geometry::Mesh;

TEST(Degenerate, nothingToReflectIn) {
  const ReflectorMesh empty(std::span<const vec3>{}, {}, {});
  EXPECT_EQ(empty.triangles().size(), 0u);
  const VirtualObjectSolver solver(empty, {0, 0, 1}, 5.0);
  EXPECT_FALSE(solver.canReflect());
  const std::vector<vec3> points{{1, 2, 3}};
  std::vector<vec3> out(1);
  std::vector<VertexKind> kinds(1, VertexKind::Reflected);
  solver.compute(Solver::Refined, points, out, kinds);
  EXPECT_EQ(kinds[0], VertexKind::None);

  const std::vector<vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {NAN, 0, 0}};
  const std::vector<vec3> normals(4, vec3(0, 0, 1));
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 1, 3};
  EXPECT_EQ(ReflectorMesh(positions, normals, indices).triangles().size(), 0u);
}

TEST(Degenerate, eyeBehindAnOpenMirrorSeesNothing) {
  const ReflectorMesh mesh = meshOf(geometry::makePlane(1, 1, 4, 4));
  const VirtualObjectSolver solver(mesh, {0.1, -1, 0.2}, 5.0);
  EXPECT_FALSE(solver.canReflect());
  for (const Solver which : {Solver::Explosion, Solver::Refined})
    EXPECT_FALSE(solver.findReflectionPoint(which, {0, 1, 0}).has_value());
  // Seen from behind, the same mesh flipped is a mirror.
  const ReflectorMesh flipped = meshOf(geometry::makePlane(1, 1, 4, 4), {.flipped = true});
  const VirtualObjectSolver other(flipped, {0.1, -1, 0.2}, 5.0);
  const auto found = other.findReflectionPoint(Solver::Refined, {0, -1, 0});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(glm::length(found->virtualPosition - dvec3(0, 1, 0)), 0, 1e-4);
}

TEST(Degenerate, awkwardEyesAndPointsGiveFiniteAnswers) {
  const Mesh bowl = geometry::flipped(geometry::makeIcosphere(0.5, 6));
  const Mesh meshes[] = {geometry::makeIcosphere(0.5, 6), bowl, geometry::makePlane(1, 1, 3, 3),
                         geometry::makeTorus(0.5, 0.2, 24, 12)};
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<dvec3> eyes{{0, 0, 0},    {0, 0.5, 0},  {0, 0, 0.5}, {0, 0, 2},
                                {1e-9, 2, 0}, {0, 1e12, 0}, {nan, 0, 0}};
  std::vector<vec3> points{{0, 0, 0},          {0, 0.5f, 0},       {0, 0, 0.5f},
                           {0, 0, 2},          {0, 0, -2},         {0, 1e20f, 0},
                           {float(nan), 0, 0}, {float(inf), 0, 0}, {0.25f, 0, 0.25f}};
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) points.push_back(vec3(randomDirection(random) * (0.01 + 0.01 * i)));
  for (const Mesh& m : meshes) {
    const ReflectorMesh mesh = meshOf(m);
    for (const dvec3& eye : eyes) {
      const VirtualObjectSolver solver(mesh, eye, 6.0);
      std::vector<vec3> out(points.size()), at(points.size());
      std::vector<VertexKind> kinds(points.size());
      for (const Solver which : {Solver::Explosion, Solver::Refined}) {
        solver.compute(which, points, out, kinds, at);
        for (std::size_t i = 0; i < points.size(); ++i) {
          if (kinds[i] == VertexKind::None) continue;
          EXPECT_TRUE(std::isfinite(out[i].x + out[i].y + out[i].z)) << i;
          EXPECT_TRUE(std::isfinite(at[i].x + at[i].y + at[i].z)) << i;
        }
      }
    }
  }
}

TEST(Degenerate, pointOnTheMirrorAndPointAtTheEye) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  const dvec3 eye(0.2, 0.3, 2);
  const VirtualObjectSolver solver(mesh, eye, 6.0);
  // Where the eye looks at its own mirror image, normal and view ray are one.
  const auto self = solver.findReflectionPoint(Solver::Refined, eye);
  ASSERT_TRUE(self.has_value());
  EXPECT_NEAR(glm::length(self->position - 0.5 * glm::normalize(eye)), 0, 2e-3);
  // A point on a facet is its own reflection.
  for (std::size_t t = 0; t < mesh.ordinaryCount(); t += 37) {
    const MirrorTriangle& triangle = mesh.triangles()[t];
    const dvec3 point = triangle.position(0.3, 0.4), normal = glm::normalize(triangle.normal(0.3, 0.4));
    if (glm::dot(normal, glm::normalize(eye - point)) < 0.1) continue;
    for (const double height : {0.0, 1e-9, 1e-6}) {
      const auto found = solver.findReflectionPoint(Solver::Refined, point + height * normal);
      ASSERT_TRUE(found.has_value()) << t << " " << height;
      EXPECT_NEAR(glm::length(found->virtualPosition - point), 0, 1e-5) << t << " " << height;
    }
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
