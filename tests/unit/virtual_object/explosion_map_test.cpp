// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/explosion_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catoptric/geometry/shapes.h"
#include "catoptric/virtual_object/item_rasterizer.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {
namespace {

TEST(ItemRasterizer, trianglesOfAFanCoverEveryPixelOnce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-5, 69);
  for (int round = 0; round < 50; ++round) {
    core::Image<int> counts(64, 64, 0);
    const std::array<dvec2, 4> square{dvec2(0, 0), dvec2(64, 0), dvec2(64, 64), dvec2(0, 64)};
    dvec2 inside(uniform(random), uniform(random));
    inside = glm::clamp(inside, dvec2(0), dvec2(64));
    if (round % 3 == 0) inside = glm::floor(inside) + 0.5;  // a corner on a pixel's centre
    for (int k = 0; k < 4; ++k) {
      std::array<dvec2, 3> triangle{square[k], square[(k + 1) % 4], inside};
      if (k % 2 == 0) std::swap(triangle[0], triangle[1]);  // either winding
      rasterizeTriangle(triangle, 64, 64, [&](int x, int y, const dvec3& w) {
        counts.at(x, y)++;
        EXPECT_NEAR(w.x + w.y + w.z, 1.0, 1e-9);
        const dvec2 p = w.x * triangle[0] + w.y * triangle[1] + w.z * triangle[2];
        EXPECT_NEAR(glm::length(p - dvec2(x + 0.5, y + 0.5)), 0.0, 0.02);
      });
    }
    for (const int count : counts.pixels()) EXPECT_EQ(count, 1);
  }
}

TEST(MapCoords, fillTheDiscAndNothingElse) {
  const MapFrame frame = makeMapFrame({1, 2, 3});
  EXPECT_NEAR(glm::length(computeMapCoords(frame, frame.z)), 0, 1e-12);
  EXPECT_NEAR(glm::length(computeMapCoords(frame, frame.x)), std::sqrt(0.5), 1e-12);
  const dvec3 nearlyAway = glm::normalize(-frame.z + 1e-4 * frame.y);
  EXPECT_NEAR(glm::length(computeMapCoords(frame, nearlyAway)), 1, 1e-6);
  // Blythe's s, with r = 2 and the origin in the middle: r/2 x / sqrt(2 (z + 1)).
  const dvec3 d = glm::normalize(dvec3(0.3, -0.5, 0.2));
  const double x = glm::dot(frame.x, d), z = glm::dot(frame.z, d);
  EXPECT_NEAR(computeMapCoords(frame, d).x, x / std::sqrt(2 * (z + 1)), 1e-12);
}

void expectComplete(const ExplosionMap& map, const ReflectorMesh& mesh) {
  const int n = map.ids.width();
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double r = std::hypot(x + 0.5 - 0.5 * n, y + 0.5 - 0.5 * n);
      const std::uint32_t id = map.ids.at(x, y);
      if (r <= 0.5 * n) {
        EXPECT_LT(id / 2, mesh.triangles().size());
      } else {
        EXPECT_EQ(id, core::kNoId);
      }
    }
}

TEST(ExplosionMap, hasNoHoleInItsCircle) {
  const geometry::Mesh meshes[] = {
      geometry::makeIcosphere(0.5, 8), geometry::makeCylinderSide(0.2, 1.5, 32, 6, true),
      geometry::makePlane(1, 0.4, 8, 4), geometry::makeTorus(0.5, 0.2, 24, 12), geometry::makeBox({1, 2, 3})};
  for (const geometry::Mesh& m : meshes) {
    const ReflectorMesh mesh(m.positions, m.normals, m.indices);
    for (const dvec3& eye : {dvec3(0.3, 2, 2), dvec3(0, 5, 1), dvec3(1, 0.3, -0.2)}) {
      const VirtualObjectSolver solver(mesh, eye, 10.0);
      ASSERT_TRUE(solver.canReflect());
      expectComplete(solver.nearMap(), mesh);
      expectComplete(solver.farMap(), mesh);
    }
  }
}

TEST(ExplosionMap, namesTheTriangleThatReflectsTheDirection) {
  const geometry::Mesh sphere = geometry::makeIcosphere(0.5, 8);
  const ReflectorMesh mesh(sphere.positions, sphere.normals, sphere.indices);
  const dvec3 eye(0.4, 1, 2.5);
  const VirtualObjectSolver solver(mesh, eye, 5.0);
  const ExplosionMap& map = solver.farMap();
  int asked = 0, named = 0;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const MirrorTriangle& triangle = mesh.triangles()[t];
    const dvec3 p = triangle.position(1. / 3, 1. / 3), n = glm::normalize(triangle.normal(1. / 3, 1. / 3));
    const dvec3 view = glm::normalize(p - eye);
    if (glm::dot(n, view) > -0.3) continue;
    const dvec3 r = core::reflectDirection(view, n);
    const double b = glm::dot(p - map.centre, r);
    const double c = glm::dot(p - map.centre, p - map.centre) - map.radius * map.radius;
    const dvec3 hit = p + (-b + std::sqrt(b * b - c)) * r;
    ++asked;
    named += map.idAt(computeMapCoords(map.frame, glm::normalize(hit - map.centre))) == 2 * t;
  }
  EXPECT_GT(asked, 300);
  EXPECT_GE(named, asked * 98 / 100);  // the curved image of a triangle is filled with straight edges
  EXPECT_EQ(map.patchedPixels, 0u);    // extension polygons reach all of the circle of a closed convex mirror
}

TEST(ExplosionMap, closedMirrorsHaveExtensionPolygonsAtTheRimOnly) {
  const geometry::Mesh sphere = geometry::makeIcosphere(0.5, 12);
  const ReflectorMesh mesh(sphere.positions, sphere.normals, sphere.indices);
  const VirtualObjectSolver solver(mesh, {0, 0, 3}, 6.0);
  const auto share = [](const ExplosionMap& map) {
    double extension = 0, all = 0;
    for (const std::uint32_t id : map.ids.pixels())
      if (id != core::kNoId) all += 1, extension += id & kExtensionBit;
    return extension / all;
  };
  // Seen from the eye, the hidden region takes half of the near sphere and little of the far one.
  EXPECT_GT(share(solver.nearMap()), 0.35);
  EXPECT_LT(share(solver.farMap()), 0.08);
  EXPECT_EQ(solver.farMap().idAt({0, 0}) & kExtensionBit, 0u);
}

TEST(HiddenMap, showsWhatTheEyeSees) {
  const geometry::Mesh sphere = geometry::makeIcosphere(0.5, 12);
  const ReflectorMesh mesh(sphere.positions, sphere.normals, sphere.indices);
  const dvec3 eye(0.3, 0.2, 2);
  const VirtualObjectSolver solver(mesh, eye, 6.0);
  const HiddenMap& map = solver.hiddenMap();
  const int n = map.ids.width();
  int right = 0, asked = 0;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const dvec3 d = glm::normalize(mesh.triangles()[t].position(1. / 3, 1. / 3) - eye);
    const dvec3 p = mesh.triangles()[t].position(1. / 3, 1. / 3);
    if (glm::dot(glm::normalize(p), eye - p) < 0.3) continue;
    const dvec2 px = (computeMapCoords(map.frame, d) - map.lower) * map.pixelsPerUnit;
    ++asked;
    right += map.ids.at(std::clamp(int(px.x), 0, n - 1), std::clamp(int(px.y), 0, n - 1)) == t;
  }
  EXPECT_GT(asked, 500);
  EXPECT_GE(right, asked * 98 / 100);
}

}  // namespace
}  // namespace catoptric::virtual_object
