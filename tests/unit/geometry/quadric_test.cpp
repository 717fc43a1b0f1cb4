// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/quadric.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"

namespace catoptric::geometry {
namespace {

std::optional<QuadricFit> fit(const Mesh& mesh) {
  return fitQuadric({mesh.positions, mesh.normals, mesh.indices});
}

TEST(QuadricFit, FindsAnEllipsoidThatWasMoved) {
  Mesh mesh = makeIcosphere(1, 10);
  const dvec3 half(0.9, 0.6, 0.3), centre(3, -2, 1);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.normals[i] = glm::normalize(mesh.normals[i] / vec3(half));
    mesh.positions[i] = vec3(dvec3(mesh.positions[i]) * half + centre);
  }
  const auto found = fit(mesh);
  ASSERT_TRUE(found);
  EXPECT_LT(found->deviation.distance, 1e-6);
  EXPECT_LT(found->deviation.angleRadians, 1e-4);
  const dvec3 on = centre + dvec3(0, 0.6, 0), g = found->quadric.gradient(on);
  EXPECT_NEAR(glm::normalize(g).y, 1, 1e-5);
  EXPECT_NEAR(glm::distance(found->quadric.project(on + 0.01 * glm::normalize(g)), on), 0, 1e-5);
  // The gradient is that of the value.
  const dvec3 p(3.3, -1.5, 1.2);
  for (int k = 0; k < 3; ++k) {
    dvec3 step(0);
    step[k] = 1e-6;
    EXPECT_NEAR((found->quadric.value(p + step) - found->quadric.value(p - step)) / 2e-6,
                found->quadric.gradient(p)[k], 1e-6);
  }
}

TEST(QuadricFit, FindsParaboloidsAndSaddles) {
  for (const double second : {0.4, 0.0, -0.3}) {
    const Mesh mesh = makeHeightField(
        16, 16, [](dvec2 at) { return at; },
        [&](dvec2 at) {
          return HeightSample{0.5 * at.x * at.x + second * at.y * at.y, at.x, 2 * second * at.y};
        });
    const auto found = fit(mesh);
    ASSERT_TRUE(found);
    EXPECT_LT(found->deviation.distance, 1e-6) << second;
    EXPECT_GT(found->quadric.gradient({0, 0, 0}).z, 0);
  }
}

TEST(QuadricFit, SaysHowFarOffItIsElsewhere) {
  const auto torus = fit(makeTorus(1, 0.3, 48, 24));
  EXPECT_TRUE(!torus || torus->deviation.distance > 0.01);
  const auto wave = fit(makeHeightField(
      24, 4, [](dvec2 at) { return 4.0 * at; },
      [](dvec2 at) {
        return HeightSample{0.2 * std::sin(2 * at.x), 0.4 * std::cos(2 * at.x), 0};
      }));
  EXPECT_TRUE(!wave || wave->deviation.distance > 0.01);
  EXPECT_FALSE(fit(makePlane(1, 1, 1, 1)));  // four vertices
}

}  // namespace
}  // namespace catoptric::geometry
