// SPDX-License-Identifier: Apache-2.0
// The file of reference images: there and back, and refused wherever it is not what was written.
#include "catoptric/depth_reflection_map/reference_file.h"

#include <gtest/gtest.h>

#include "catoptric/core/error.h"

namespace catoptric::depth_reflection_map {
namespace {

constexpr std::uint64_t kScene = 0x1234;

StoredImage makeImage(int index) {
  StoredImage image;
  image.key = {3, true, -2, index};
  image.camera.width = 3, image.camera.height = 2;
  image.camera.centre = {1.5, -2, index};
  image.camera.worldFromZexel[1] = {0.25, 4, -1};
  for (std::uint32_t i = 0; i < 6; ++i) {
    image.radiance.push_back(0x3c003c0000000000u + i);
    image.zexels.emplace_back(i * 77u, i);
  }
  return image;
}

std::vector<std::byte> makeFile() {
  std::map<ReferenceKey, std::vector<std::byte>> records;
  for (const int index : {4, 7}) records[makeImage(index).key] = packImage(makeImage(index));
  return packReferences(kScene, records);
}

std::string refusalOf(std::span<const std::byte> bytes, std::uint64_t scene = kScene) {
  try {
    static_cast<void>(unpackReferences(bytes, scene));
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return {};
}

TEST(ReferenceFile, ThereAndBack) {
  const auto records = unpackReferences(makeFile(), kScene);
  ASSERT_EQ(records.size(), 2u);
  const StoredImage image = unpackImage(records.at(makeImage(7).key)), expected = makeImage(7);
  EXPECT_EQ(image.key, expected.key);
  EXPECT_EQ(image.camera.centre, expected.camera.centre);
  EXPECT_EQ(image.camera.worldFromZexel, expected.camera.worldFromZexel);
  EXPECT_EQ(image.radiance, expected.radiance);
  EXPECT_EQ(image.zexels, expected.zexels);
  EXPECT_TRUE(unpackReferences(packReferences(kScene, {}), kScene).empty());
}

TEST(ReferenceFile, EveryChangedByteIsNoticed) {
  const std::vector<std::byte> file = makeFile();
  EXPECT_EQ(refusalOf(file), "");
  for (std::size_t i = 0; i < file.size(); ++i) {
    std::vector<std::byte> changed = file;
    changed[i] ^= std::byte(0x40);
    EXPECT_NE(refusalOf(changed), "") << i;
  }
}

TEST(ReferenceFile, EveryShorterFileIsRefusedAndALongerOne) {
  std::vector<std::byte> file = makeFile();
  for (std::size_t size = 0; size < file.size(); ++size)
    EXPECT_NE(refusalOf(std::span(file).first(size)), "") << size;
  file.push_back(std::byte(0));
  EXPECT_EQ(refusalOf(file), "zexel.damaged");
}

TEST(ReferenceFile, SaysWhatIsWrong) {
  std::vector<std::byte> file = makeFile();
  EXPECT_EQ(refusalOf(file, kScene + 1), "zexel.other_scene");
  EXPECT_EQ(refusalOf(std::span(file).first(file.size() - 1)), "zexel.truncated");
  file[8] = std::byte(2);
  EXPECT_EQ(refusalOf(file), "zexel.version");
  file[0] = std::byte('X');
  EXPECT_EQ(refusalOf(file), "zexel.foreign");
}

TEST(ReferenceFile, FingerprintDependsOnWhatIsSeen) {
  scene::Scene scene;
  scene.materials.resize(1);
  scene::WorldGeometry world;
  world.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const scene::Environment dark = scene::makeConstantEnvironment(vec3(0));
  const std::uint64_t before = computeSceneFingerprint(scene, world, dark);
  EXPECT_EQ(computeSceneFingerprint(scene, world, dark), before);
  EXPECT_NE(computeSceneFingerprint(scene, world, scene::makeConstantEnvironment(vec3(1))), before);
  scene.materials[0].roughness = 0.25f;
  EXPECT_NE(computeSceneFingerprint(scene, world, dark), before);
  scene.materials[0].roughness = 1.0f;
  world.positions[1].x = 1.5f;
  EXPECT_NE(computeSceneFingerprint(scene, world, dark), before);
}

}  // namespace
}  // namespace catoptric::depth_reflection_map
