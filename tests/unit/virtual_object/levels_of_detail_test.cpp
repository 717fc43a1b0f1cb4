// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/levels_of_detail.h"

#include <gtest/gtest.h>

#include <optional>

#include "catoptric/geometry/shapes.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/scene/world_motion.h"

namespace catoptric::virtual_object {

using namespace raster;

namespace {

/// A mirror ball at the origin, a fine painted ball beside it, and what a test adds.
struct BallScene {
  scene::Scene scene;
  scene::WorldGeometry world;
  std::optional<scene::WorldMotion> motion;

  BallScene() {
    scene::Material mirror, paint;
    mirror.metallic = 1, mirror.roughness = 0;
    paint.metallic = 0, paint.roughness = 0.8f;
    scene.materials = {mirror, paint, scene::Material{}};
    add(geometry::makeIcosphere(0.5, 12), 0, dmat4(1.0));
    add(geometry::makeIcosphere(0.3, 24), 1, geometry::moveBy({2, 0, 0}));
  }
  int add(const geometry::Mesh& mesh, int material, const dmat4& worldFromMesh) {
    scene::MeshPrimitive primitive;
    primitive.positions = mesh.positions, primitive.normals = mesh.normals, primitive.indices = mesh.indices;
    primitive.material = material;
    scene.meshes.push_back({"mesh", {primitive}});
    scene::Instance instance;
    instance.name = "instance " + std::to_string(scene.instances.size());
    instance.mesh = int(scene.meshes.size()) - 1;
    instance.worldFromMesh = worldFromMesh;
    scene.instances.push_back(instance);
    return int(scene.instances.size()) - 1;
  }
  void finish() {
    world = scene::makeWorldGeometry(scene);
    motion.emplace(scene, world, scene::ReflectorOptions{});
  }
  [[nodiscard]] std::uint32_t partOf(int instance) const {
    for (std::uint32_t p = 0; p < world.parts.size(); ++p)
      if (world.parts[p].object == std::uint32_t(instance)) return p;
    return core::kNoId;
  }
};

TEST(LevelsOfDetail, areChosenByTheDistanceToTheMirror) {
  BallScene balls;
  balls.finish();
  LevelsOfDetail levels(balls.scene, balls.world);
  ASSERT_GE(levels.levels(balls.partOf(1)).size(), 2u);
  std::size_t last = 0;
  for (const double x : {0.9, 1.5, 3.0, 6.0, 12.0, 25.0}) {
    const auto moved = balls.motion->shiftInstance(1, dvec3(x - 2, 0, 0));
    levels.update(balls.scene, balls.world, moved);
    const TessellatedObjects objects = tessellateForReflector(balls.world, 0, {.levels = &levels});
    EXPECT_GE(objects.simplifiedTriangles, last) << x;
    last = objects.simplifiedTriangles;
    const TessellatedObjects finer =
        tessellateForReflector(balls.world, 0, {.maxErrorPx = 0.02, .levels = &levels});
    EXPECT_LE(finer.simplifiedTriangles, objects.simplifiedTriangles);
    for (const std::uint32_t number : objects.sourceTriangles)
      ASSERT_EQ(levels.triangleParts()[number], balls.partOf(1));
  }
  EXPECT_GT(last, 0.9 * 20 * 24 * 24);
  EXPECT_EQ(tessellateForReflector(balls.world, 0, {}).simplifiedTriangles, 0u);
}

TEST(LevelsOfDetail, errorsGrowWithTheInstanceAndAreSharedByAll) {
  BallScene balls;
  const int large = balls.add(geometry::makeIcosphere(0.3, 24), 1,
                              geometry::moveBy({-4, 0, 0}) * geometry::scaleBy(dvec3(2)));
  balls.scene.instances[std::size_t(large)].mesh = balls.scene.instances[1].mesh;
  balls.finish();
  const LevelsOfDetail levels(balls.scene, balls.world);
  const auto small = levels.levels(balls.partOf(1)), big = levels.levels(balls.partOf(large));
  ASSERT_EQ(small.size(), big.size());
  for (std::size_t i = 0; i < small.size(); ++i) {
    EXPECT_NEAR(levels.findDistance(balls.partOf(large), big[i]),
                2 * levels.findDistance(balls.partOf(1), small[i]), 1e-9);
    EXPECT_EQ(small[i].triangleCount, big[i].triangleCount);
    for (const std::uint32_t v : levels.corners(big[i])) {
      const scene::Part& part = balls.world.parts[balls.partOf(large)];
      ASSERT_TRUE(v >= part.firstVertex && v < part.firstVertex + part.vertexCount);
    }
  }
}

TEST(LevelsOfDetail, leaveOutWhatDeformsAndMirrorsThatAreNotConvex) {
  BallScene balls;
  const int bending = balls.add(geometry::makeIcosphere(0.3, 24), 1, geometry::moveBy({0, 3, 0}));
  balls.scene.meshes[std::size_t(bending)].primitives[0].deformation.emplace();
  const int hollow = balls.add(geometry::flipped(geometry::makeIcosphere(9, 24)), 0, dmat4(1.0));
  const int convex = balls.add(geometry::makeIcosphere(0.3, 24), 0, geometry::moveBy({0, -3, 0}));
  balls.finish();
  const LevelsOfDetail levels(balls.scene, balls.world);
  EXPECT_TRUE(levels.levels(balls.partOf(bending)).empty());
  EXPECT_TRUE(levels.levels(balls.partOf(hollow)).empty());
  EXPECT_FALSE(levels.levels(balls.partOf(convex)).empty());
}

void expectEqual(const TessellatedObjects& a, const TessellatedObjects& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uv0, b.uv0);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.sourceTriangles, b.sourceTriangles);
  EXPECT_EQ(a.parts.size(), b.parts.size());
  EXPECT_EQ(a.edgeFactor, b.edgeFactor);
  EXPECT_EQ(a.simplifiedTriangles, b.simplifiedTriangles);
}

TEST(ReflectorTessellation, isAsIfMadeAnewAfterThingsHaveMoved) {
  BallScene balls;
  balls.add(geometry::makeBox({1, 1, 1}), 1, geometry::moveBy({-2, 0, 0}));
  balls.finish();
  LevelsOfDetail levels(balls.scene, balls.world);
  const std::uint32_t mirror = balls.world.parts[balls.partOf(0)].reflector;
  for (const std::size_t budget : {600000u, 1500u}) {
    TessellationOptions options{.isSeenDirectly = true, .maxTriangles = budget, .levels = &levels};
    ReflectorTessellation kept(balls.world, mirror, options);
    for (const double x : {0.5, 6.0, 20.0, -1.0, 0.0}) {
      const auto moved = balls.motion->shiftInstance(1, dvec3(x, 0, 0.1));
      levels.update(balls.scene, balls.world, moved);
      kept.update(balls.world, moved);
      expectEqual(kept.objects(), tessellateForReflector(balls.world, mirror, options));
    }
  }
}

}  // namespace
}  // namespace catoptric::virtual_object
