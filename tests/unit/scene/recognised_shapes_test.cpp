// SPDX-License-Identifier: Apache-2.0
// What shape a mirror is taken for: the simplest that fits, or the declared one.
#include <gtest/gtest.h>

#include <cmath>

#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/world_geometry.h"
#include "mirror_meshes.h"

namespace catoptric::scene {
namespace {

TEST(RecognisedShapes, RecognisesCylinderAndCone) {
  const dmat4 placed = glm::translate(dmat4(1), dvec3(1, 2, 3)) * glm::rotate(dmat4(1), 0.7, dvec3(1, 1, 0)) *
                       glm::scale(dmat4(1), dvec3(2));
  const WorldGeometry cylinder =
      makeWorldGeometry(makeScene(makeFrustum(40, 1), makeMirrorMaterial(), placed));
  ASSERT_EQ(cylinder.reflectors.size(), 1u);
  EXPECT_EQ(cylinder.reflectors[0].shape, ReflectorShape::Cylinder);
  EXPECT_TRUE(cylinder.reflectors[0].isConvex);
  const WorldGeometry cone = makeWorldGeometry(makeScene(makeFrustum(40, 0.4), makeMirrorMaterial(), placed));
  ASSERT_EQ(cone.reflectors.size(), 1u);
  EXPECT_EQ(cone.reflectors[0].shape, ReflectorShape::Cone);
  EXPECT_TRUE(cone.reflectors[0].isConvex);
}

TEST(RecognisedShapes, StretchedSphereIsAQuadric) {
  const WorldGeometry world = makeWorldGeometry(
      makeScene(makeSphere(48, 24), makeMirrorMaterial(), glm::scale(dmat4(1), dvec3(1, 1.3, 0.8))));
  ASSERT_EQ(world.reflectors.size(), 1u);
  EXPECT_EQ(world.reflectors[0].shape, ReflectorShape::Quadric);
  EXPECT_TRUE(world.reflectors[0].isConvex);
  // Normals went by the inverse transpose: they are perpendicular to the ellipsoid.
  for (std::size_t v = 0; v < world.positions.size(); ++v) {
    const dvec3 p(world.positions[v]);
    const dvec3 gradient = glm::normalize(p / dvec3(1, 1.69, 0.64));
    EXPECT_NEAR(glm::dot(gradient, dvec3(world.normals[v])), 1, 1e-5);
  }
}

/// z(x, y) over the square of half width 1, front towards +z; `height` gives z and its derivatives.
template <class Height>
MeshPrimitive makeGraph(const Height& height) {
  MeshPrimitive graph;
  const int n = 20;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const dvec2 p(2.0 * i / n - 1, 2.0 * j / n - 1);
      const dvec3 z = height(p);
      graph.positions.push_back(vec3(dvec3(p, z.x)));
      graph.normals.push_back(vec3(glm::normalize(dvec3(-z.y, -z.z, 1))));
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i;
      graph.indices.insert(graph.indices.end(), {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1});
    }
  return graph;
}

/// z = -0.2 r^2 + a4 r^4 - bend x^3.
MeshPrimitive makeBulge(double a4, double bend = 0) {
  return makeGraph([=](dvec2 p) {
    const double u = glm::dot(p, p), slope = -0.4 + 4 * a4 * u;
    return dvec3(-0.2 * u + a4 * u * u - bend * p.x * p.x * p.x, slope * p.x - 3 * bend * p.x * p.x,
                 slope * p.y);
  });
}

TEST(RecognisedShapes, RecognisesTorusAndAsphericMirrorOnlyWhereNothingSimplerFits) {
  const auto shapeOf = [](const MeshPrimitive& mesh) {
    const WorldGeometry world = makeWorldGeometry(makeScene(mesh));
    EXPECT_EQ(world.reflectors.size(), 1u);
    EXPECT_LT(world.reflectors.at(0).fitError, 1e-5);
    return world.reflectors.at(0).shape;
  };
  const geometry::Mesh ring = geometry::makeTorus(0.5, 0.2, 48, 24);
  MeshPrimitive torus;
  torus.positions = ring.positions, torus.normals = ring.normals, torus.indices = ring.indices;
  EXPECT_EQ(shapeOf(torus), ReflectorShape::Torus);
  EXPECT_EQ(shapeOf(makeBulge(-0.05)), ReflectorShape::Aspheric);
  EXPECT_EQ(shapeOf(makeBulge(0)), ReflectorShape::Quadric);
  EXPECT_EQ(shapeOf(makeBulge(-0.05, 0.05)), ReflectorShape::Mesh);
  EXPECT_EQ(shapeOf(makeSphere(24, 12)), ReflectorShape::Sphere);
}

TEST(RecognisedShapes, SaysHowFarADeclaredAsphericMirrorIsLeft) {
  Material material = makeMirrorMaterial();
  material.hint.shape = "aspheric";
  const WorldGeometry close = makeWorldGeometry(makeScene(makeBulge(-0.05, 0.002), material));
  EXPECT_EQ(close.reflectors.at(0).shape, ReflectorShape::Aspheric);
  EXPECT_GT(close.reflectors.at(0).fitError, 1e-4);
  const WorldGeometry none = makeWorldGeometry(makeScene(makeCube(), material));
  EXPECT_EQ(none.reflectors.at(0).shape, ReflectorShape::Plane);
}

TEST(RecognisedShapes, SaddleIsNotConvex) {
  const WorldGeometry world = makeWorldGeometry(makeScene(
      makeGraph([](dvec2 p) { return dvec3(0.2 * (p.x * p.x - p.y * p.y), 0.4 * p.x, -0.4 * p.y); })));
  ASSERT_EQ(world.reflectors.size(), 1u);
  EXPECT_EQ(world.reflectors[0].shape, ReflectorShape::Quadric);
  EXPECT_FALSE(world.reflectors[0].isConvex);
}

TEST(RecognisedShapes, NormalMappedMirrorIsNoPlane) {
  Material material = makeMirrorMaterial();
  material.normalTexture.texture = 0;
  material.hint.shape = "plane";
  Scene scene = makeScene(makeFlatShadedQuad(), material);
  scene.textures.resize(1);
  EXPECT_EQ(makeWorldGeometry(scene).reflectors.at(0).shape, ReflectorShape::Mesh);
}

TEST(RecognisedShapes, DeclaredShapeWins) {
  Material material = makeMirrorMaterial();
  material.hint.shape = "mesh";
  EXPECT_EQ(makeWorldGeometry(makeScene(makeSphere(24, 12), material)).reflectors.at(0).shape,
            ReflectorShape::Mesh);
}

}  // namespace
}  // namespace catoptric::scene
