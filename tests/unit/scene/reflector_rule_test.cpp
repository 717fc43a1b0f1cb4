// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/reflector_rule.h"

#include <gtest/gtest.h>

namespace catoptric::scene {
namespace {

Scene makeScene(const Material& material) {
  Scene scene;
  scene.materials = {material, Material{}};
  return scene;
}

Material makeMirrorMaterial() {
  Material material;
  material.roughness = 0;
  return material;
}

TEST(ReflectorRule, NodeBeatsMaterialBeatsRule) {
  const auto decide = [](const Material& material, const ReflectorHint& node = {}) {
    Scene scene = makeScene(material);
    return ReflectorRule(scene, {}).decide(0, node);
  };
  Material material;
  EXPECT_FALSE(decide(material).isReflector) << "glTF's default is rough";
  material.roughness = 0.05f;
  EXPECT_TRUE(decide(material).isReflector);
  material.metallic = 0.89f;
  EXPECT_FALSE(decide(material).isReflector);
  material.clearcoat = 0.5f;
  EXPECT_TRUE(decide(material).isReflector);
  EXPECT_EQ(decide(material).clearcoat, 0.5f);
  EXPECT_EQ(decide(material).reflectivity, 0);
  material.clearcoatRoughness = 0.2f;
  EXPECT_FALSE(decide(material).isReflector);
  material.hint.reflector = true;
  material.hint.reflectivity = 0.8f;
  EXPECT_TRUE(decide(material).isReflector);
  EXPECT_EQ(decide(material).reflectivity, 0.8f);
  ReflectorHint node;
  node.reflector = false;
  EXPECT_FALSE(decide(material, node).isReflector) << "the node beats the material";
  material.hint = {};
  node.reflector = true;
  node.reflectivity = 0.3f;
  EXPECT_EQ(decide(material, node).reflectivity, 0.3f);
  material = makeMirrorMaterial();
  material.hint.reflector = false;
  EXPECT_FALSE(decide(material).isReflector);
  material = makeMirrorMaterial();
  material.unlit = true;
  EXPECT_FALSE(decide(material).isReflector);
}

TEST(ReflectorRule, ASmoothSolidThatLetsLightThroughIsARefractor) {
  Material glass;
  glass.metallic = glass.roughness = 0;
  glass.transmission = glass.thickness = 1;
  const auto decide = [](const Material& material) {
    const Scene scene = makeScene(material);
    return ReflectorRule(scene, {}).decide(0, {});
  };
  EXPECT_TRUE(decide(glass).isReflector && decide(glass).isRefractor);
  Material other = glass;
  other.thickness = 0;
  EXPECT_FALSE(decide(other).isReflector) << "a thin wall";
  other = glass;
  other.roughness = 0.3f;
  EXPECT_FALSE(decide(other).isReflector) << "frosted";
  other = glass;
  other.transmission = 0.4f;
  EXPECT_FALSE(decide(other).isReflector);
  other = glass;
  other.hint.reflector = false;
  EXPECT_FALSE(decide(other).isReflector);
  other.hint.reflector = true;
  EXPECT_TRUE(decide(other).isReflector);
  EXPECT_FALSE(decide(other).isRefractor) << "who calls it a mirror gets a mirror";
}

TEST(ReflectorRule, TexturedRoughnessMustHoldEverywhere) {
  Material material;
  material.metallicRoughnessTexture.texture = 0;
  Scene scene = makeScene(material);
  scene.textures.resize(1);
  scene.textures[0].image = core::ImageRgba8(16, 16, {0, 5, 255, 255});
  EXPECT_TRUE(ReflectorRule(scene, {}).decide(0, {}).isReflector);
  for (int x = 0; x < 16; ++x) scene.textures[0].image.at(x, 0) = {0, 60, 255, 255};
  const ReflectorDecision decision = ReflectorRule(scene, {}).decide(0, {});
  EXPECT_FALSE(decision.isReflector);
  EXPECT_NE(decision.reason.find("varies"), std::string::npos) << decision.reason;
}

}  // namespace
}  // namespace catoptric::scene
