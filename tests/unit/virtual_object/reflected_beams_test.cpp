// SPDX-License-Identifier: Apache-2.0
// Culling of what a mirror cannot reflect: nothing is lost. The twin has beams that are too narrow, and must
// lose some.
#include "catoptric/virtual_object/reflected_beams.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/culling.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "reflection_harness.h"
#include "solver_test_support.h"

namespace catoptric::virtual_object {
namespace {

/// A cap of a ball around the origin that bulges towards +z, as a wing mirror does; `sign` -1: hollow.
geometry::Mesh makeCap(double radius, double halfWidth, float sign, double halfHeight = 0) {
  geometry::Mesh mesh =
      geometry::makePlane(2 * halfWidth, 2 * (halfHeight > 0 ? halfHeight : halfWidth), 12, 12);
  for (vec3& p : mesh.positions)
    p = vec3(p.x, -p.z, sign * std::sqrt(float(radius * radius) - p.x * p.x - p.z * p.z));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.normals[i] = sign * glm::normalize(mesh.positions[i]);
  return mesh;
}

core::Box boxOf(std::initializer_list<dvec3> points) {
  core::Box box;
  for (const dvec3& point : points) box.add(point);
  return box;
}

ReflectedBeams beamsOf(const ReflectorMesh& mesh, const dvec3& eye) {
  return VirtualObjectSolver(mesh, eye, 20).reflectedBeams();
}

struct Counts {
  int reflected = 0, lost = 0, culled = 0;
};

/// Random points all around; `inwards`: by how much all planes are moved.
Counts countLost(const ReflectorMesh& mesh, const dvec3& eye, float inwards = 0) {
  const VirtualObjectSolver solver(mesh, eye, 20);
  ReflectedBeams beams = solver.reflectedBeams();
  for (ReflectedBeams::Beam& beam : beams.beams)
    for (BeamPlane& plane : beam) plane.distance += inwards;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> logDistance(std::log(1.5), std::log(15.0));
  Counts counts;
  for (int i = 0; i < 4000; ++i) {
    const dvec3 point = mesh.centre() + randomDirection(random) * std::exp(logDistance(random));
    const auto found = solver.findReflectionPoint(Solver::Refined, point);
    const bool isReflected = found && found->kind == VertexKind::Reflected;
    const bool isKept = beams.mayMeet(boxOf({point}));
    counts.reflected += isReflected;
    counts.lost += isReflected && !isKept;
    counts.culled += !isKept;
  }
  return counts;
}

TEST(ReflectedBeams, HoldEveryReflectedPoint) {
  for (const dvec3& eye : {dvec3(0.5, 0.2, 4), dvec3(-2, 1, 2.5)}) {
    const Counts convex = countLost(meshOf(makeCap(2, 0.4, 1)), eye);
    EXPECT_EQ(convex.lost, 0);
    EXPECT_GT(convex.reflected, 100);
    EXPECT_GT(convex.culled, 1000);
    EXPECT_GT(countLost(meshOf(makeCap(2, 0.4, 1)), eye, 0.5f).lost, 0);
  }
  const Counts hollow = countLost(meshOf(makeCap(8, 1.2, -1)), dvec3(0.5, 0.2, -4));
  EXPECT_EQ(hollow.lost, 0);
  EXPECT_GT(hollow.reflected, 20);
}

TEST(ReflectedBeams, HoldHardlyMore) {
  const ReflectorMesh mesh = meshOf(makeCap(2, 0.6, 1, 0.15));
  for (const dvec3& eye : {dvec3(0.5, 0.2, 4), dvec3(-1, 0.6, 3)}) {
    const Counts counts = countLost(mesh, eye);
    EXPECT_EQ(counts.lost, 0);
    EXPECT_GT(counts.reflected, 50);
    EXPECT_LT(4000 - counts.culled, 2.2 * counts.reflected);
  }
}

TEST(ReflectedBeams, OfMirrorsThatTurnRoundFarAreSeveral) {
  const ReflectorMesh mesh = meshOf(makeCap(0.5, 0.25, 1));
  EXPECT_GT(beamsOf(mesh, dvec3(0, 0, 4)).beams.size(), 3u);
  EXPECT_EQ(countLost(mesh, dvec3(0.3, 0, 4)).lost, 0);
  EXPECT_GT(countLost(mesh, dvec3(0.3, 0, 4)).culled, 500);
}

TEST(ReflectedBeams, ABallReflectsAllAround) {
  const ReflectorMesh mesh = meshOf(geometry::makeIcosphere(0.5, 12));
  const ReflectedBeams beams = beamsOf(mesh, dvec3(0, 0, 3));
  ASSERT_EQ(beams.beams.size(), 1u);
  EXPECT_TRUE(beams.mayMeet(boxOf({dvec3(0, 0, -7)})));
  EXPECT_EQ(countLost(mesh, dvec3(0, 0, 3)).culled, 0);
}

TEST(ReflectedBeams, OfARectangleOfAPictureHoldWhatItShows) {
  const dvec3 eye(1, 2, 3);
  const dmat4 clip =
      glm::perspective(0.9, 1.5, 0.1, 100.0) * glm::lookAt(eye, dvec3(-2, 0, 1), dvec3(0, 1, 0));
  const ivec2 size(600, 400);
  const gl::Scissor rectangle{420, 60, 90, 200};
  ReflectedBeams beams;
  makePictureBeam(clip, eye, size, rectangle, beams);
  std::mt19937 random(6);
  int inside = 0;
  for (int i = 0; i < 40000; ++i) {
    const dvec3 point = eye + 7.0 * randomDirection(random);
    const dvec4 at = clip * dvec4(point, 1);
    const dvec2 px = (dvec2(at) / at.w + 1.0) * 0.5 * dvec2(size) - dvec2(rectangle.x, rectangle.y);
    const dvec2 outside = glm::max(-px, px - dvec2(rectangle.width, rectangle.height));
    const double far = std::max(outside.x, outside.y);
    if (at.w > 0 && far < 0) {
      EXPECT_TRUE(beams.mayMeet(boxOf({point})));
      ++inside;
    }
    if (at.w < 0 || far > 2) {
      EXPECT_FALSE(beams.mayMeet(boxOf({point})));
    }
  }
  EXPECT_GT(inside, 100);
}

/// A flat mirror in y = 5.
const dmat4& mirrored() {
  static const dmat4 matrix =
      glm::translate(dmat4(1), dvec3(0, 10, 0)) * glm::scale(dmat4(1), dvec3(1, -1, 1));
  return matrix;
}

TEST(ReflectedBeams, MoveAsTheWorldDoes) {
  const ReflectedBeams beams = beamsOf(meshOf(makeCap(2, 0.4, 1)), dvec3(0.5, 0.2, 4));
  const ReflectedBeams moved = moveToWorld(beams, mirrored());
  std::mt19937 random(8);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 point = 14.0 * randomDirection(random), seen(mirrored() * dvec4(point, 1));
    const bool isMet = beams.mayMeet(boxOf({seen}));
    EXPECT_EQ(moved.mayMeet(boxOf({point})), isMet) << i;
    met += isMet;
  }
  EXPECT_GT(met, 20);
}

TEST(TriangleRuns, LeaveOutOnlyWhatNoRayMeets) {
  const ReflectedBeams beams = beamsOf(meshOf(makeCap(2, 0.4, 1)), dvec3(0.5, 0.2, 4));
  const geometry::Mesh floor = geometry::makePlane(30, 30, 60, 60);
  const TriangleRuns runs(floor.positions, floor.indices);
  std::vector<std::uint8_t> mayMeet, mayMeetMirrored;
  const std::size_t leftOut = runs.mark(beams, dmat4(1.0), mayMeet);
  runs.mark(beams, mirrored(), mayMeetMirrored);
  ASSERT_EQ(mayMeet.size(), floor.indices.size() / 3);
  EXPECT_EQ(std::size_t(std::count(mayMeet.begin(), mayMeet.end(), 0)), leftOut);
  EXPECT_GT(leftOut, mayMeet.size() / 3);
  EXPECT_NE(mayMeetMirrored, mayMeet);
  std::size_t met = 0;
  for (std::size_t i = 0; i < floor.indices.size(); ++i) {
    const dvec3 point(floor.positions[floor.indices[i]]);
    if (beams.mayMeet(boxOf({point}))) {
      EXPECT_EQ(mayMeet[i / 3], 1) << i;
      ++met;
    }
    if (beams.mayMeet(boxOf({dvec3(mirrored() * dvec4(point, 1))}))) {
      EXPECT_EQ(mayMeetMirrored[i / 3], 1) << i;
    }
  }
  EXPECT_GT(met, 50u);
}

/// A floor before a wing mirror, with large and small triangles.
struct Floor {
  test::TestWorld world{makeCap(2, 0.4, 1)};
  raster::TessellatedObjects objects;
  Floor() {
    world.add(geometry::makeQuad({-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}), true);
    objects = raster::tessellateForReflector(world.geometry(), 0);
  }
  [[nodiscard]] dvec3 corner(std::size_t i) const { return dvec3(objects.positions[objects.indices[i]]); }
};

bool hasBit(const std::vector<VertexBits>& bits, std::size_t vertex) {
  return (bits[vertex / VertexRuns::kLength] >> vertex % VertexRuns::kLength & 1u) != 0;
}

TEST(VertexRuns, KeepEveryCornerOfWhatIsReflected) {
  const Floor floor;
  const ReflectorMesh mesh(floor.world.geometry(), 0);
  const VirtualObjectSolver solver(mesh, dvec3(0.5, 0.2, 4), 20);
  const VertexRuns runs(floor.objects);
  std::vector<VertexBits> bits;
  runs.findReflected(solver.reflectedBeams(), dmat4(1.0), bits);
  ASSERT_EQ(bits.size(), runs.runs());
  std::mt19937 random(12);
  std::uniform_real_distribution<double> share(0, 1);
  int reflected = 0;
  for (std::size_t i = 0; i + 2 < floor.objects.indices.size(); i += 3) {
    const double u = share(random), v = share(random) * (1 - u);
    const dvec3 inside = floor.corner(i) * (1 - u - v) + floor.corner(i + 1) * u + floor.corner(i + 2) * v;
    const auto found = solver.findReflectionPoint(Solver::Refined, inside);
    if (!found || found->kind != VertexKind::Reflected) continue;
    ++reflected;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(hasBit(bits, floor.objects.indices[i + k])) << i;
  }
  EXPECT_GT(reflected, 100);
  EXPECT_GT(runs.countLeftOut(bits), floor.objects.positions.size() / 4);
}

TEST(VertexRuns, AskTheBoxAroundEachVertexsTriangles) {
  const Floor floor;
  const ReflectorMesh mesh(floor.world.geometry(), 0);
  const ReflectedBeams beams = beamsOf(mesh, dvec3(0.5, 0.2, 4));
  const VertexRuns runs(floor.objects);
  std::vector<core::Box> boxes(floor.objects.positions.size());
  for (std::size_t i = 0; i < floor.objects.indices.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) boxes[floor.objects.indices[i]].add(floor.corner(i - i % 3 + k));
  for (const dmat4& beamsFromWorld : {dmat4(1.0), mirrored()}) {
    std::vector<VertexBits> bits;
    runs.findReflected(beams, beamsFromWorld, bits);
    const ReflectedBeams moved = moveToWorld(beams, beamsFromWorld);
    std::size_t kept = 0, leftOut = 0;
    for (std::size_t v = 0; v < boxes.size(); ++v) {
      const core::Box smaller{boxes[v].lower + 1e-4, boxes[v].upper - 1e-4},
          larger{boxes[v].lower - 1e-4, boxes[v].upper + 1e-4};
      if (moved.mayMeet(smaller)) {
        EXPECT_TRUE(hasBit(bits, v)) << v;
        ++kept;
      }
      if (!moved.mayMeet(larger)) {
        EXPECT_FALSE(hasBit(bits, v)) << v;
        ++leftOut;
      }
    }
    EXPECT_GT(kept + leftOut, boxes.size() * 95 / 100);
    EXPECT_GT(leftOut, 100u);
  }
}

TEST(VertexRuns, CountWhatIsLeftOut) {
  raster::TessellatedObjects objects;
  objects.positions.resize(25);
  const VertexRuns runs(objects);
  EXPECT_EQ(runs.countLeftOut({}), 0u);
  EXPECT_EQ(runs.countLeftOut(std::vector<VertexBits>{0xffff, 0}), 9u);
  EXPECT_EQ(runs.countLeftOut(std::vector<VertexBits>{0x0f03, 0xffff}), 10u);
  std::vector<VertexBits> bits;  // nothing uses these vertices
  runs.findReflected({{{}}}, dmat4(1.0), bits);
  EXPECT_EQ(runs.countLeftOut(bits), 25u);
}

TEST(VertexRuns, WhatIsLeftOutChangesNoOther) {
  const ReflectorMesh cap = meshOf(makeCap(2, 0.4, 1)), hollow = meshOf(makeCap(2, 0.4, -1));
  for (const ReflectorMesh* mesh : {&cap, &hollow}) {
    const VirtualObjectSolver solver(*mesh, dvec3(0.5, 0.2, mesh == &cap ? 4 : 1), 20);
    std::mt19937 random(5);
    constexpr std::size_t kRun = VertexRuns::kLength;
    std::vector<vec3> points(3 * kRun + kRun / 2 + 1);
    for (vec3& p : points) p = vec3(mesh->centre() + 5.0 * randomDirection(random));
    std::vector<vec3> all(points.size()), some(points.size());
    std::vector<VertexKind> allKinds(points.size()), someKinds(points.size());
    solver.compute(Solver::Refined, points, all, allKinds);
    const std::vector<VertexBits> mayReflect{0xffff, 0, 0x53a1, 0xfffe};
    solver.compute(Solver::Refined, points, some, someKinds, {}, mayReflect);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool isIn = hasBit(mayReflect, i);
      EXPECT_EQ(someKinds[i], isIn ? allKinds[i] : VertexKind::None);
      if (isIn) {
        EXPECT_EQ(some[i], all[i]);
      }
    }
  }
}

TEST(Tessellation, SizeFollowsTheMirrorOnTheScreen) {
  scene::Reflector mirror;
  mirror.radius = 0.5;
  scene::CameraFrame camera;
  camera.heightPx = 1000;
  camera.tanHalfFovY = 0.5;  // 1000 pixels a radian: diameter 1000 / distance
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 100}, camera), 43.75);
  EXPECT_NEAR(raster::findTessellationSize(mirror, {0, 0, 4.5}, camera), 247.487, 1e-3);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 3}, camera), 350);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 0.8}, camera), 1400);
  EXPECT_EQ(raster::findTessellationSize(mirror, {0, 0, 0}, camera), 2800);
}

}  // namespace
}  // namespace catoptric::virtual_object
