// SPDX-License-Identifier: Apache-2.0
// Laws of reflection points: the mirror law, Fermat, closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "catoptric/core/parallel.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

using geometry::Mesh;

SolverOptions exactly() {
  SolverOptions options;
  options.tolerance = 1e-12;
  options.newtonSteps = 40;
  return options;
}

/// The reflection point on a sphere around the origin, by bisection of the angle in the plane of E, Q and
/// centre.
dvec3 findOnSphere(double radius, const dvec3& eye, const dvec3& point) {
  const dvec3 x = glm::normalize(eye);
  dvec3 y = point - glm::dot(point, x) * x;
  y = glm::length(y) > 1e-12 ? glm::normalize(y) : dvec3(0);
  const auto tangential = [&](double angle) {  // of the half vector; positive: J lies farther on
    const dvec3 n = std::cos(angle) * x + std::sin(angle) * y,
                along = -std::sin(angle) * x + std::cos(angle) * y;
    const dvec3 j = radius * n;
    return glm::dot(glm::normalize(eye - j) + glm::normalize(point - j), along);
  };
  double low = 0, high = std::acos(std::clamp(glm::dot(glm::normalize(point), x), -1.0, 1.0));
  for (int i = 0; i < 100; ++i) (tangential(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return radius * (std::cos(low) * x + std::sin(low) * y);
}

/// True where the segment eye - point misses the sphere around the origin by a margin.
bool isOutsideShadow(double radius, const dvec3& eye, const dvec3& point) {
  const dvec3 d = point - eye;
  const double t = std::clamp(-glm::dot(eye, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::length(eye + t * d) > radius;
}

struct Case {
  dvec3 eye, point;
};

std::vector<Case> makeCases(int count, double radius, double margin) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Case> cases;
  dvec3 eye(0);
  while (int(cases.size()) < count) {
    if (cases.size() % 20 == 0) eye = randomDirection(random) * radius * (1.5 + 6 * uniform(random));
    const dvec3 point = randomDirection(random) * radius * (1.01 + 8 * uniform(random) * uniform(random));
    if (isOutsideShadow(radius * margin, eye, point)) cases.push_back({eye, point});
  }
  return cases;
}

/// A solver whose maps are rebuilt only when the eye changes.
class MovingSolver {
 public:
  MovingSolver(const ReflectorMesh& mesh, const SolverOptions& options = {})
      : solver_(mesh, dvec3(9), 6.0, options) {}
  const VirtualObjectSolver& at(const dvec3& eye) {
    if (eye != solver_.eye()) solver_.setEye(eye);
    return solver_;
  }

 private:
  VirtualObjectSolver solver_;
};

TEST(Refined, obeysTheMirrorLawOnRandomConfigurations) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  MovingSolver moving(mesh, exactly());
  for (const Case& c : makeCases(400, 0.5, 1.02)) {
    const VirtualObjectSolver& solver = moving.at(c.eye);
    const auto found = solver.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->kind, VertexKind::Reflected);
    EXPECT_LE(found->residual, 1e-11);
    // In words of its own: the view ray mirrored at the normal meets Q, and Q' lies on the view ray at path
    // length.
    const dvec3 view = glm::normalize(found->position - c.eye);
    const dvec3 reflected = core::reflectDirection(view, found->normal);
    EXPECT_LE(glm::length(glm::cross(reflected, glm::normalize(c.point - found->position))), 1e-9);
    EXPECT_GT(glm::dot(reflected, c.point - found->position), 0);
    const double path = glm::length(found->position - c.eye) + glm::length(c.point - found->position);
    EXPECT_NEAR(glm::length(found->virtualPosition - (c.eye + path * view)), 0, 1e-9);
    EXPECT_LT(glm::dot(found->normal, view), 0);
  }
}

TEST(Refined, pathLengthIsStationaryOnTheSmoothSurface) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 40));
  MovingSolver moving(mesh, exactly());
  for (const Case& c : makeCases(50, 0.5, 1.1)) {
    const VirtualObjectSolver& solver = moving.at(c.eye);
    const auto found = solver.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(found.has_value());
    const dvec3 j = 0.5 * glm::normalize(found->position);  // facets lie up to 1e-4 inside the sphere
    const auto length = [&](const dvec3& p) { return glm::length(p - c.eye) + glm::length(c.point - p); };
    for (const dvec3& side : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}) {
      const dvec3 tangent = glm::cross(glm::normalize(j), side);
      const double step = 1e-3;
      const dvec3 a = 0.5 * glm::normalize(j + step * tangent), b = 0.5 * glm::normalize(j - step * tangent);
      EXPECT_NEAR((length(a) - length(b)) / (2 * step), 0, 2e-3);
      EXPECT_GE(0.5 * (length(a) + length(b)), length(j) - 1e-9);  // a minimum on a convex mirror
    }
  }
}

TEST(Refined, agreesWithTheClosedFormOfASphere) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 64));
  double worst = 0;
  MovingSolver moving(mesh, exactly());
  for (const Case& c : makeCases(100, 0.5, 1.05)) {
    const VirtualObjectSolver& solver = moving.at(c.eye);
    const auto found = solver.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(found.has_value());
    worst = std::max(worst, glm::length(found->position - findOnSphere(0.5, c.eye, c.point)));
  }
  EXPECT_LE(worst, 1.5e-4);  // the facets' own distance from the sphere is 4e-5
}

TEST(Refined, defaultToleranceCostsNoVisibleAccuracy) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 24));
  MovingSolver usually(mesh), precisely(mesh, exactly());
  for (const Case& c : makeCases(300, 0.5, 1.02)) {
    const VirtualObjectSolver &usual = usually.at(c.eye), &exact = precisely.at(c.eye);
    const auto a = usual.findReflectionPoint(Solver::Refined, c.point);
    const auto b = exact.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(a.has_value() && b.has_value());
    EXPECT_LE(glm::length(a->position - b->position), 0.5 * 3e-5);  // 0.01 px on a sphere 700 px wide
  }
}

TEST(Refined, aFlatPatchMirrorsLikeAPlane) {
  const Mesh plane = geometry::makePlane(2, 2, 6, 6);
  const ReflectorMesh mesh = meshOf(plane);
  EXPECT_TRUE(mesh.isOpen());
  const dvec3 eye(0.3, 1.5, 0.8);
  const VirtualObjectSolver solver(mesh, eye, 8.0, exactly());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const core::Plane mirror{{0, 1, 0}, 0};
  int reflected = 0;
  for (int i = 0; i < 200; ++i) {
    const dvec3 point(2 * uniform(random), 1.2 + uniform(random), 2 * uniform(random));
    const auto found = solver.findReflectionPoint(Solver::Refined, point);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(glm::length(found->virtualPosition - core::reflectPoint(point, mirror)), 0, 1e-9);
    // Mirroring the virtual point again gives the point back.
    EXPECT_NEAR(glm::length(core::reflectPoint(found->virtualPosition, mirror) - point), 0, 1e-9);
    const dvec3 j = found->position;
    const bool isOnPatch = std::max(std::abs(j.x), std::abs(j.z)) <= 1.0;
    EXPECT_EQ(found->kind, isOnPatch ? VertexKind::Reflected : VertexKind::PastBoundary);
    reflected += isOnPatch;
  }
  EXPECT_GT(reflected, 100);
}

TEST(Refined, eyeAndPointMayBeExchanged) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  MovingSolver forth(mesh, exactly()), other(mesh, exactly());
  for (const Case& c : makeCases(50, 0.5, 1.05)) {
    const VirtualObjectSolver &there = forth.at(c.eye), &back = other.at(c.point);
    const auto a = there.findReflectionPoint(Solver::Refined, c.point);
    const auto b = back.findReflectionPoint(Solver::Refined, c.eye);
    ASSERT_TRUE(a.has_value() && b.has_value());
    EXPECT_NEAR(glm::length(a->position - b->position), 0, 1e-9);
  }
}

TEST(Refined, crossesTextureSeams) {
  // Same sphere, once with a seam of duplicated vertices: the same reflection points.
  const Mesh seamed = geometry::makeUvSphere(0.5, 48, 24);
  const ReflectorMesh mesh = meshOf(seamed);
  EXPECT_FALSE(mesh.isOpen()) << mesh.boundaryEdges();
  EXPECT_TRUE(mesh.isConvex());
  MovingSolver moving(mesh, exactly());
  for (const Case& c : makeCases(200, 0.5, 1.03)) {
    const VirtualObjectSolver& solver = moving.at(c.eye);
    const auto found = solver.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->kind, VertexKind::Reflected);
    EXPECT_LE(found->residual, 1e-11);
  }
}

TEST(Explosion, isRoughlyRightAndFarWorseThanRefined) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 24));
  double explosion = 0;
  int count = 0;
  MovingSolver moving(mesh);
  for (const Case& c : makeCases(300, 0.5, 1.2)) {
    const VirtualObjectSolver& solver = moving.at(c.eye);
    const auto e = solver.findReflectionPoint(Solver::Explosion, c.point);
    const auto r = solver.findReflectionPoint(Solver::Refined, c.point);
    ASSERT_TRUE(e.has_value() && r.has_value());
    const dvec3 a = glm::normalize(e->virtualPosition - c.eye),
                b = glm::normalize(r->virtualPosition - c.eye);
    // In pixels of a sphere that is 700 px wide.
    explosion += glm::length(a - b) / (0.5 / glm::length(c.eye)) * 350;
    ++count;
  }
  explosion /= count;
  EXPECT_LE(explosion, 60.0);  // methods.md: tens of pixels
  EXPECT_GE(explosion, 2.0);   // else the comparison above compares nothing
}

TEST(Hidden, pointsBehindAConvexMirrorFallOutsideItsImage) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 24));
  const dvec3 eye(0, 0, 3);
  const VirtualObjectSolver solver(mesh, eye, 8.0);
  const double rim = std::asin(0.5 / 3.0);
  for (double depth : {0.7, 1.5, 4.0})
    for (double share : {0.99, 0.9, 0.7, 0.4}) {
      const double angle = rim * share;
      const dvec3 point = eye + dvec3(std::sin(angle), 0, -std::cos(angle)) * (3.0 + depth);
      for (const Solver which : {Solver::Explosion, Solver::Refined}) {
        const auto found = solver.findReflectionPoint(which, point);
        ASSERT_TRUE(found.has_value());
        EXPECT_EQ(found->kind, VertexKind::DoublyVirtual);
        const dvec3 seen = found->virtualPosition - eye;
        const double seenAngle = std::atan2(seen.x, -seen.z);
        const bool isInFront = glm::length(seen) < glm::length(found->position - eye);
        EXPECT_TRUE(seenAngle > rim || isInFront) << depth << " " << share << " " << seenAngle / rim;
      }
    }
}

TEST(Hidden, meetsReflectedPointsWhereAnObjectTouchesTheMirror) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 24));
  const dvec3 eye(0.4, 0.6, 3), foot = 0.5 * glm::normalize(dvec3(0.1, 0.3, 1));
  const VirtualObjectSolver solver(mesh, eye, 8.0);
  const dvec3 normal = glm::normalize(foot);
  const dvec3 along = glm::normalize(normal + 0.8 * glm::cross(normal, dvec3(0, 1, 0)));
  const double h = 0.004;
  const auto outside = solver.findReflectionPoint(Solver::Refined, foot + h * along);
  const auto inside = solver.findReflectionPoint(Solver::Refined, foot - h * along);
  ASSERT_TRUE(outside.has_value() && inside.has_value());
  EXPECT_EQ(outside->kind, VertexKind::Reflected);
  EXPECT_EQ(inside->kind, VertexKind::DoublyVirtual);
  const dvec3 middle = 0.5 * (outside->virtualPosition + inside->virtualPosition);
  EXPECT_LE(glm::length(middle - foot), 0.05 * h + 3e-4);  // 3e-4: the facet's depth below the sphere
}

TEST(Skirt, continuesASphereAndACylinder) {
  // The upper half of a sphere: its skirt has to stay on the sphere, with the sphere's normals.
  Mesh dome = geometry::makeUvSphere(1.0, 96, 48);
  std::vector<std::uint32_t> upper;
  for (std::size_t i = 0; i < dome.indices.size(); i += 3) {
    const auto y = [&](int k) { return dome.positions[dome.indices[i + k]].y; };
    if (y(0) > -1e-4f && y(1) > -1e-4f && y(2) > -1e-4f)
      upper.insert(upper.end(), dome.indices.begin() + long(i), dome.indices.begin() + long(i) + 3);
  }
  dome.indices = upper;
  const ReflectorMesh mesh = meshOf(dome);
  EXPECT_TRUE(mesh.isOpen());
  EXPECT_GT(mesh.triangles().size(), mesh.ordinaryCount());
  double lowest = 0;
  for (std::size_t v = 0; v < mesh.positions().size(); ++v) {
    EXPECT_NEAR(glm::length(mesh.positions()[v]), 1.0, 0.01);
    EXPECT_GE(glm::dot(glm::normalize(mesh.positions()[v]), mesh.normals()[v]), std::cos(0.03));
    lowest = std::min(lowest, mesh.positions()[v].y);
  }
  EXPECT_LT(lowest, -0.3);

  const ReflectorMesh tube = meshOf(geometry::makeCylinderSide(0.3, 1.0, 48, 4, true));
  EXPECT_EQ(tube.boundaryEdges(), 96u);  // the texture's seam is no boundary
  for (std::size_t v = 0; v < tube.positions().size(); ++v) {
    EXPECT_NEAR(std::hypot(tube.positions()[v].x, tube.positions()[v].z), 0.3, 1e-6);
    EXPECT_NEAR(tube.normals()[v].y, 0, 1e-6);
  }
}

TEST(Solver, theSameWhateverTheThreadsAndAfterAChangeOfEye) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  std::vector<vec3> points;
  points.reserve(5000);
  std::mt19937 random(11);
  for (int i = 0; i < 5000; ++i) points.push_back(vec3(randomDirection(random) * (0.6 + 0.001 * i)));
  const auto run = [&](VirtualObjectSolver& solver) {
    std::vector<vec3> out(points.size());
    std::vector<VertexKind> kinds(points.size());
    solver.compute(Solver::Refined, points, out, kinds);
    return out;
  };
  VirtualObjectSolver solver(mesh, {0, 1, 2}, 6.0);
  const auto first = run(solver);
  solver.setEye({1, 2, 0});
  const auto other = run(solver);
  solver.setEye({0, 1, 2});
  core::setThreadCount(1);
  const auto again = run(solver);
  core::setThreadCount(0);
  EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(vec3)), 0);
  EXPECT_NE(std::memcmp(first.data(), other.data(), first.size() * sizeof(vec3)), 0);
}

}  // namespace
}  // namespace catoptric::virtual_object
