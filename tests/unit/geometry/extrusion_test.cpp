// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/extrusion.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"

namespace catoptric::geometry {
namespace {

MeshView view(const Mesh& mesh) {
  return {mesh.positions, mesh.normals, mesh.indices};
}

Mesh makeCurtain(double waves) {  // z = cos(waves x), straight along y
  const auto place = [](dvec2 s) { return dvec2(s.x, 0.4 * s.y); };
  return makeHeightField(40, 6, place, [=](dvec2 p) {
    return HeightSample{0.05 * std::cos(waves * p.x), -0.05 * waves * std::sin(waves * p.x), 0};
  });
}

TEST(FitExtrusion, FindsTheProfileWhateverThePlacement) {
  const dmat4 place = moveBy({3, -1, 2}) * turnAround({1, 2, 3}, 1.1);
  for (const dmat4& worldFromMesh : {dmat4(1.0), place}) {
    const auto fit = fitExtrusion(view(transformed(makeCurtain(5), worldFromMesh)));
    ASSERT_TRUE(fit);
    EXPECT_FALSE(fit->isClosed);
    ASSERT_EQ(fit->points.size(), 41u);
    EXPECT_NEAR(fit->high - fit->low, 0.8, 1e-5);
    const dvec3 axis = glm::normalize(dvec3(worldFromMesh * dvec4(0, 1, 0, 0)));
    EXPECT_NEAR(std::abs(glm::dot(fit->axis, axis)), 1, 1e-6);
    EXPECT_LT(fit->deviation.distance, 1e-5);
    EXPECT_LT(fit->deviation.angleRadians, 1e-4);
    for (std::size_t i = 0; i + 1 < fit->points.size(); ++i) {
      const dvec2 along = fit->points[i + 1] - fit->points[i], n = fit->normals[i];
      EXPECT_NEAR(glm::length(along), 0.05, 0.01);  // neighbours are neighbours
      EXPECT_GT(along.x * n.y - along.y * n.x, 0);  // bright side to the left
      EXPECT_LT(std::abs(glm::dot(along, n)), 0.15 * glm::length(along));
    }
  }
}

TEST(FitExtrusion, ClosesARing) {
  const auto fit = fitExtrusion(view(makeCylinderSide(0.5, 2, 48, 3, false)));
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->isClosed);
  EXPECT_EQ(fit->points.size(), 48u);
}

TEST(FitExtrusion, RefusesWhatIsNone) {
  EXPECT_FALSE(fitExtrusion(view(makeIcosphere(1, 6))));
  EXPECT_FALSE(fitExtrusion(view(makePlane(1, 1, 4, 4))));
  EXPECT_FALSE(fitExtrusion(view(makeCone(0.5, 0.2, 1, 32, false))));
  EXPECT_FALSE(fitExtrusion(MeshView{}));
}

}  // namespace
}  // namespace catoptric::geometry
