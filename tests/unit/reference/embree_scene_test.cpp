// SPDX-License-Identifier: Apache-2.0
// Closest hits by Embree against brute force over all triangles, for both packet widths.
#include "catoptric/reference/embree_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "traced_scene.h"

namespace catoptric::reference {
namespace {

/// Triangles here and there, half of them single-sided.
TracedTestScene makeSoup(int triangles) {
  TracedTestScene t;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const bool doubleSided : {false, true}) {
    scene::MeshPrimitive mesh;
    for (int i = 0; i < triangles; ++i) {
      const vec3 centre(uniform(random), uniform(random), uniform(random));
      for (int k = 0; k < 3; ++k) {
        mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
        mesh.positions.push_back(centre + 0.3f * vec3(uniform(random), uniform(random), uniform(random)));
        mesh.normals.push_back({0, 1, 0});
      }
    }
    scene::Material material = makeUnlit(vec3(1));
    material.doubleSided = doubleSided;
    t.add(mesh, material);
  }
  t.finish();
  return t;
}

/// Nearest triangle by Moeller & Trumbore in double; `margin` is how far the hit is from an edge or from
/// being missed.
std::uint32_t findByBruteForce(const scene::WorldGeometry& world, const std::vector<bool>& doubleSided,
                               const Ray& ray, std::uint32_t ignored, double* margin) {
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t found = core::kNoId;
  *margin = 1;
  for (std::uint32_t i = 0; i < world.triangleCount(); ++i) {
    const dvec3 a(world.positions[world.indices[3 * i]]), b(world.positions[world.indices[3 * i + 1]]),
        c(world.positions[world.indices[3 * i + 2]]);
    const dvec3 n = glm::cross(b - a, c - a);
    const double across = glm::dot(ray.direction, n);
    if (i == ignored || across == 0 || (across > 0 && !doubleSided[world.triangleParts[i]])) continue;
    const double t = glm::dot(a - ray.origin, n) / across;
    const dvec3 p = ray.origin + t * ray.direction - a;
    const double u = glm::dot(glm::cross(p, c - a), n) / glm::dot(n, n),
                 v = glm::dot(glm::cross(b - a, p), n) / glm::dot(n, n);
    const double inside = std::min({u, v, 1 - u - v});
    if (t > 0 && std::abs(inside) < *margin) *margin = std::abs(inside);
    if (inside < 0 || t <= 0 || t >= nearest) continue;
    nearest = t;
    found = i;
  }
  return found;
}

TEST(EmbreeScene, FindsWhatBruteForceFinds) {
  const TracedTestScene t = makeSoup(200);
  const SurfaceShader shader(t.scene, t.world, t.environment);
  std::vector<bool> doubleSided;
  for (const scene::Part& part : t.world.parts) doubleSided.push_back(shader.materialOf(part).doubleSided);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Ray> rays(501);  // no multiple of a packet
  std::vector<TraceRequest> requests(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto rounded = [&](double scale) {
      return dvec3(vec3(dvec3(uniform(random), uniform(random), uniform(random)) * scale));
    };
    rays[i].origin = rounded(2);
    rays[i].direction = dvec3(vec3(glm::normalize(rounded(1) - rays[i].origin)));
    rays[i].differential = {{dvec3(0), dvec3(0)}, {dvec3(0), dvec3(0)}};
    requests[i].ray = &rays[i];
    if (i % 3 == 0) requests[i].ignoredTriangle = std::uint32_t(i);
  }
  std::vector<TraceAnswer> wide(rays.size()), narrow(rays.size());
  EmbreeScene(t.world, shader, 8).intersect(requests, wide);
  EmbreeScene(t.world, shader, 4).intersect(requests, narrow);
  int hits = 0, compared = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double margin = 0;
    const std::uint32_t expected =
        findByBruteForce(t.world, doubleSided, rays[i], requests[i].ignoredTriangle, &margin);
    if (margin < 1e-5) continue;  // float and double may differ at an edge
    EXPECT_EQ(wide[i].triangle, expected) << i;
    EXPECT_EQ(narrow[i].triangle, expected) << i;
    hits += expected != core::kNoId ? 1 : 0;
    ++compared;
  }
  EXPECT_GT(compared, 480);
  EXPECT_GT(hits, 300);
}

TEST(EmbreeScene, NonFiniteRaysHitNothing) {
  const TracedTestScene t = makeSoup(50);
  const SurfaceShader shader(t.scene, t.world, t.environment);
  const EmbreeScene embree(t.world, shader);
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  std::vector<Ray> rays(6);
  for (Ray& ray : rays) ray = {dvec3(0), dvec3(0, 0, 1), {{dvec3(0), dvec3(0)}, {dvec3(0), dvec3(0)}}};
  rays[0].origin.x = nan;
  rays[1].direction.y = nan;
  rays[2].origin.z = infinity;
  rays[3].direction = dvec3(0);
  rays[4].origin.x = 1e30;
  std::vector<TraceRequest> requests(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) requests[i].ray = &rays[i];
  requests[5].tNear = std::numeric_limits<float>::quiet_NaN();
  std::vector<TraceAnswer> answers(rays.size(), TraceAnswer{7, 0, 0, 0});
  embree.intersect(requests, answers);
  for (const TraceAnswer& answer : answers) EXPECT_EQ(answer.triangle, core::kNoId);
  embree.intersect({}, {});
}

}  // namespace
}  // namespace catoptric::reference
