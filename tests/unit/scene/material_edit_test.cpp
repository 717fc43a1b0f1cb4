// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/material_edit.h"

#include <gtest/gtest.h>

#include "catoptric/scene/built_in_scenes.h"
#include "catoptric/scene/gltf_import.h"

namespace catoptric::scene {
namespace {

/// Made once: its textures take a second.
const Scene& boxScene() {
  static const Scene scene = importGltf(makeBuiltInScene("checker-box"), {}, "checker-box");
  return scene;
}

struct Edited {
  Scene scene = boxScene();
  WorldGeometry world = makeWorldGeometry(scene);
  int mirror = world.reflectors.at(0).material;

  bool change(const MaterialValues& values) { return changeMaterial(scene, world, {}, mirror, values); }
  [[nodiscard]] MaterialValues values() const {
    return readMaterialValues(scene.materials[std::size_t(mirror)]);
  }
};

void expectSameReflectors(const WorldGeometry& a, const WorldGeometry& b) {
  ASSERT_EQ(a.reflectors.size(), b.reflectors.size());
  for (std::size_t i = 0; i < a.reflectors.size(); ++i) {
    EXPECT_EQ(a.reflectors[i].reflectivity, b.reflectors[i].reflectivity) << i;
    EXPECT_EQ(a.reflectors[i].clearcoat, b.reflectors[i].clearcoat) << i;
    EXPECT_EQ(a.reflectors[i].reason, b.reflectors[i].reason) << i;
  }
}

TEST(MaterialEdit, ValuesAreReadBackAsWritten) {
  Edited edited;
  const MaterialValues wanted{vec3(0.1f, 0.2f, 0.3f), 0.95f, 0.02f, 0.5f};
  EXPECT_TRUE(edited.change(wanted));
  EXPECT_EQ(edited.values(), wanted);
  EXPECT_EQ(edited.scene.materials[std::size_t(edited.mirror)].baseColor.a, 1.0f);
}

TEST(MaterialEdit, MirrorsThatStayAreAsInAWorldMadeAnew) {
  Edited edited;
  MaterialValues values = edited.values();
  values.reflectivity = 0.25f;
  values.roughness = 0.03f;
  ASSERT_TRUE(edited.change(values));
  EXPECT_EQ(edited.world.reflectors[0].reflectivity, 0.25f);
  expectSameReflectors(edited.world, makeWorldGeometry(edited.scene));
}

TEST(MaterialEdit, SaysWhenAMirrorCeasesToBeOneAndWhenItIsBack) {
  Edited edited;
  MaterialValues values = edited.values();
  const float smooth = values.roughness;
  values.roughness = 0.5f;
  EXPECT_FALSE(edited.change(values));
  edited.world = makeWorldGeometry(edited.scene);
  values.roughness = 0.6f;
  EXPECT_TRUE(edited.change(values)) << "rough before and after";
  values.roughness = smooth;
  EXPECT_FALSE(edited.change(values));
}

}  // namespace
}  // namespace catoptric::scene
