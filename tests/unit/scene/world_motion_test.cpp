// SPDX-License-Identifier: Apache-2.0
// Files with animations, moved in the world: sample models against values by hand, strictness, mirrors that
// move.
#include "catoptric/scene/world_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "gltf_test_support.h"

namespace catoptric::scene {
namespace {

using gltf_test::Document;

/// A triangle on a node that moves from the origin to (2, 0, 0) in a second; `values` may be broken.
Document makeMoving(const std::vector<float>& times = {0, 1},
                    const std::vector<float>& values = {0, 0, 0, 2, 0, 0}, const char* path = "translation",
                    const char* type = "VEC3") {
  Document document = gltf_test::makeTriangle();
  const int input = document.addFloats(times, "SCALAR"), output = document.addFloats(values, type);
  document.json["animations"] = {
      {{"name", "move"},
       {"samplers", {{{"input", input}, {"output", output}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  return document;
}

struct Moving {
  Scene scene;
  WorldGeometry world;
  WorldMotion motion;
  explicit Moving(Scene from, const std::string& animation = {})
      : scene(std::move(from)), world(makeWorldGeometry(scene)), motion(scene, world, {}, animation) {}
};

TEST(WorldMotion, anInstanceFollowsItsNode) {
  Moving m(gltf_test::import(makeMoving()));
  ASSERT_EQ(m.motion.movingParts().size(), 1u);
  m.motion.setTime(0.25);
  EXPECT_EQ(m.world.positions[0], vec3(0.5f, 0, 0));
  EXPECT_EQ(m.world.bounds.upper.x, 1.5);
  m.motion.setTime(9);
  EXPECT_EQ(m.world.positions[0], vec3(2, 0, 0));
  m.motion.setTime(0);  // and back: nothing adds up
  EXPECT_EQ(m.world.positions[0], vec3(0));
  EXPECT_EQ(m.world.normals[0], vec3(0, 0, 1));
}

TEST(WorldMotion, aShiftIsKeptWhileTheNodeMoves) {
  Moving m(gltf_test::import(makeMoving()));
  ASSERT_EQ(m.motion.shiftInstance(0, dvec3(0, 4, 0)).size(), 1u);  // in the rest pose
  EXPECT_EQ(m.world.positions[0], vec3(0, 4, 0));
  EXPECT_EQ(m.motion.shiftInstance(0, dvec3(0, 4, 0)).size(), 0u) << "it is there already";
  m.motion.setTime(0.25);
  EXPECT_EQ(m.world.positions[0], vec3(0.5f, 4, 0));
  EXPECT_EQ(m.world.bounds.upper.y, 5);
  (void)m.motion.shiftInstance(0, dvec3(0));
  EXPECT_EQ(m.world.positions[0], vec3(0.5f, 0, 0));
}

TEST(WorldMotion, keyFramesAreReadStrictly) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refuse = [](const Document& document) {
    const auto error = gltf_test::importError(document);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), "gltf.accessor_data") << error->what();
    EXPECT_EQ(error->pointer().rfind("/accessors/", 0), 0u) << error->pointer();
  };
  refuse(makeMoving({0, 0}));
  refuse(makeMoving({1, 0.5f}));
  refuse(makeMoving({-1, 0}));
  refuse(makeMoving({0, nan}));
  refuse(makeMoving({0, 1}, {0, 0, 0, nan, 0, 0}));
  refuse(makeMoving({0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}, "rotation", "VEC4"));  // a rotation of zero
}

TEST(WorldMotion, aScaleThatTurnsNegativeTurnsTheWinding) {
  Moving m(gltf_test::import(makeMoving({0, 1}, {1, 1, 1, -1, 1, 1}, "scale")));
  const auto facing = [&] {
    const vec3 a = m.world.positions[m.world.indices[0]], b = m.world.positions[m.world.indices[1]],
               c = m.world.positions[m.world.indices[2]];
    return glm::cross(b - a, c - a).z;
  };
  m.motion.setTime(0.1);
  EXPECT_GT(facing(), 0);
  m.motion.setTime(0.9);
  EXPECT_GT(facing(), 0);  // mirrored geometry, same front
  EXPECT_EQ(m.world.normals[0], vec3(0, 0, 1));
  m.motion.setTime(0.1);
  EXPECT_GT(facing(), 0);
}

TEST(WorldMotion, aMirrorTakesItsPlaneAlong) {
  Document document = makeMoving({0, 1}, {0, 0, 0, 0, 0, 3});
  document.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}}};
  document.json["meshes"][0]["primitives"][0]["material"] = 0;
  Moving m(gltf_test::import(document));
  ASSERT_EQ(m.world.reflectors.size(), 1u);
  m.motion.setTime(0.5);
  const Reflector& mirror = m.world.reflectors[0];
  ASSERT_EQ(mirror.shape, ReflectorShape::Plane);
  EXPECT_NEAR(mirror.plane.signedDistance({0, 0, 1.5}), 0, 1e-6);
  EXPECT_NEAR(mirror.plane.normal.z, 1, 1e-6);
  EXPECT_NEAR(mirror.centre.z, 1.5, 1e-6);
}

std::optional<std::filesystem::path> findSample(const std::string& name) {
  const char* folder = std::getenv("CATOPTRIC_ASSETS");
  if (folder == nullptr) return std::nullopt;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(folder) / "khronos"))
    if (entry.path().filename() == name) return entry.path();
  return std::nullopt;
}

/// Every sample moves, stays finite and comes back to the same bytes.
TEST(WorldMotion, sampleModelsPlay) {
  if (!std::getenv("CATOPTRIC_ASSETS")) GTEST_SKIP() << "CATOPTRIC_ASSETS is not set";
  for (const char* name : {"AnimatedCube", "BoxAnimated", "AnimatedMorphCube", "AnimatedMorphSphere",
                           "AnimatedTriangle", "CesiumMan", "Fox", "InterpolationTest", "RiggedSimple",
                           "RiggedFigure", "SimpleMorph", "SimpleSkin"}) {
    auto path = findSample(std::string(name) + ".glb");
    if (!path) path = findSample(std::string(name) + ".gltf");
    ASSERT_TRUE(path) << name;
    Moving m(importGltf(*path));
    ASSERT_FALSE(m.motion.movingParts().empty()) << name;
    const double end = m.motion.choice().durationS;
    m.motion.setTime(0.3 * end);
    const std::vector<vec3> early = m.world.positions;
    m.motion.setTime(0.6 * end);
    EXPECT_NE(early, m.world.positions) << name;
    for (std::size_t i = 0; i < m.world.positions.size(); ++i) {
      ASSERT_TRUE(std::isfinite(glm::length(m.world.positions[i]))) << name;
      ASSERT_NEAR(glm::length(m.world.normals[i]), 1, 1e-4) << name;
    }
    m.motion.setTime(0.3 * end);
    EXPECT_EQ(early, m.world.positions) << name;
  }
}

TEST(WorldMotion, simpleMorphByHand) {
  // Two targets move the tip of a triangle by (-1, 1, 0) and (1, 1, 0); weights 0,0 -> 0,1 -> 1,1 -> 1,0 ->
  // 0,0.
  const auto path = findSample("SimpleMorph.gltf");
  if (!path) GTEST_SKIP() << "CATOPTRIC_ASSETS is not set";
  Moving m(importGltf(*path));
  const auto highest = [&] {
    vec3 best = m.world.positions[0];
    for (const vec3& p : m.world.positions)
      if (p.y > best.y) best = p;
    return best;
  };
  m.motion.setTime(0);
  EXPECT_EQ(highest(), vec3(0.5f, 0.5f, 0));
  m.motion.setTime(0.5);
  EXPECT_EQ(highest(), vec3(1, 1, 0));
  m.motion.setTime(2);
  EXPECT_EQ(highest(), vec3(0.5f, 2.5f, 0));
}

}  // namespace
}  // namespace catoptric::scene
