// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/convex_edges.h"

#include <gtest/gtest.h>

#include "catoptric/geometry/mesh_inspection.h"

namespace catoptric::geometry {
namespace {

/// z = -(x^2 + y^2) / 2 on a sheared grid, every cell cut along the same diagonal.
Mesh makeShearedDome(int cells, double shear) {
  Mesh mesh;
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column) {
      const double u = 2.0 * column / cells - 1, v = 2.0 * row / cells - 1;
      const double x = u + shear * v * v, y = v + shear * u;
      mesh.positions.push_back(vec3(x, y, -0.5 * (x * x + y * y)));
      mesh.normals.push_back(vec3(glm::normalize(dvec3(x, y, 1))));
    }
  const auto at = [&](int column, int row) { return std::uint32_t(row * (cells + 1) + column); };
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column)
      mesh.indices.insert(mesh.indices.end(),
                          {at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row),
                           at(column + 1, row + 1), at(column, row + 1)});
  return mesh;
}

TEST(ConvexEdges, ShearedGridOfAConvexSurfaceBecomesConvex) {
  for (double shear : {0.1, 0.4, -0.6}) {
    const Mesh mesh = makeShearedDome(16, shear);
    EXPECT_GT(findDeepestConcavity(mesh, 1e-9), 1e-3) << shear;
    const Mesh fixed = withConvexEdges(mesh);
    EXPECT_EQ(findDeepestConcavity(fixed, 1e-9), 0) << shear;
    EXPECT_EQ(fixed.triangleCount(), mesh.triangleCount());
    EXPECT_EQ(fixed.positions, mesh.positions);
    const EdgeReport edges = inspectEdges(fixed, 1e-9);
    EXPECT_EQ(edges.inconsistent + edges.nonManifold, 0u);
  }
}

TEST(ConvexEdges, BowlStaysABowlAndTerminates) {
  const Mesh bowl = flipped(makeShearedDome(8, 0.2));
  const Mesh result = withConvexEdges(bowl);
  EXPECT_EQ(result.triangleCount(), bowl.triangleCount());
  EXPECT_GT(findDeepestConcavity(result, 1e-9), 1e-3);
}

}  // namespace
}  // namespace catoptric::geometry
