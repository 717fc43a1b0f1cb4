// SPDX-License-Identifier: Apache-2.0
// The writer is the importer's inverse: what goes out comes back in, to the last bit of every float.
#include "catoptric/scene/glb_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "catoptric/scene/gltf_import.h"

namespace catoptric::scene {
namespace {

Texture makeTexture(const std::string& name, int width, int height, std::uint8_t alpha) {
  Texture texture;
  texture.name = name;
  texture.image = core::ImageRgba8(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      texture.image.at(x, y) = {std::uint8_t(x * 7), std::uint8_t(y * 5), 100, alpha};
  texture.wrapU = Wrap::MirroredRepeat;
  texture.wrapV = Wrap::ClampToEdge;
  texture.magnifyNearest = true;
  return texture;
}

/// Everything the writer can write, once.
Scene makeEverything() {
  Scene scene;
  scene.name = "everything";
  scene.textures = {makeTexture("pattern", 8, 4, 255), makeTexture("glass", 4, 4, 90)};
  Material m;
  m.name = "painted";
  m.baseColor = {0.25f, 0.5f, 0.75f, 0.5f};
  m.baseColorTexture.texture = 0;
  m.baseColorTexture.uvFromMesh = mat3(2, 0, 0, 0, 3, 0, 0.25f, 0.5f, 1);
  m.metallic = 0.3f;
  m.roughness = 0.7f;
  m.occlusionTexture = {1, 1, mat3(1.0f)};
  m.occlusionStrength = 0.8f;
  m.emissive = {4, 2, 1};
  m.alphaMode = AlphaMode::Mask;
  m.alphaCutoff = 0.25f;
  m.doubleSided = true;
  m.ior = 1.33f;
  m.specular = 0.5f;
  m.clearcoat = 0.9f;
  m.clearcoatRoughness = 0.02f;
  m.transmission = 0.75f;
  m.thickness = 0.1f;
  m.attenuationColor = {0.5f, 0.25f, 1};
  m.attenuationDistance = 0.4f;
  m.hint.reflector = true;
  m.hint.shape = "sphere";
  m.hint.reflectivity = 0.8f;
  Material plain;
  plain.unlit = true;
  plain.alphaMode = AlphaMode::Blend;
  scene.materials = {m, plain};
  MeshPrimitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0.1f}, {0, 1.0f / 3, 0}, {1, 1, -0.2f}};
  primitive.normals = {{0, 0, 1}, {0, 0.6f, 0.8f}, {1, 0, 0}, {0, 1, 0}};
  primitive.uv[0] = {{0, 0}, {1, 0}, {0, 1}, {1.5f, -2}};
  primitive.uv[1] = {{0, 0}, {0.5f, 0}, {0, 0.5f}, {0.25f, 0.125f}};
  primitive.colors = {vec4(1), vec4(0.5f), vec4(0.25f, 0, 1, 1), vec4(0)};
  primitive.indices = {0, 1, 2, 2, 1, 3};
  primitive.material = 0;
  scene.meshes.push_back({"sheet", {primitive}});
  Instance instance;
  instance.name = "placed";
  instance.mesh = 0;
  instance.worldFromMesh = glm::translate(dmat4(1.0), dvec3(1, 2, 3));
  instance.hint.shell = true;
  scene.instances = {instance, instance};
  scene.instances[1].worldFromMesh = glm::scale(dmat4(1.0), dvec3(-2, 1, 1));
  Light light;
  light.type = LightType::Spot;
  light.color = {2, 1, 0.5f};
  light.position = {1, 5, 2};
  light.direction = {0, -1, 0};
  light.range = 9;
  light.innerConeRadians = 0.2f;
  light.outerConeRadians = 0.5f;
  scene.lights = {light};
  Camera camera;
  camera.name = "eye";
  camera.eye = {1, 2, 3};
  camera.target = {0, 1, -2};
  camera.fovYRadians = 0.8;
  scene.cameras = {camera};
  return scene;
}

nlohmann::json readDocument(const std::vector<std::byte>& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const char* text = reinterpret_cast<const char*>(glb.data() + 20);
  return nlohmann::json::parse(text, text + length);
}

TEST(GlbWriter, ComesBackThroughTheImporter) {
  const Scene out = makeEverything();
  const Scene in = importGltf(makeGlb(out), {}, "everything.glb");
  EXPECT_TRUE(in.warnings.empty()) << in.warnings.front();
  ASSERT_EQ(in.meshes.size(), 1u);
  const MeshPrimitive &a = out.meshes[0].primitives[0], &b = in.meshes[0].primitives.at(0);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uv[0], b.uv[0]);
  EXPECT_EQ(a.uv[1], b.uv[1]);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.indices, b.indices);
  ASSERT_EQ(in.instances.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(in.instances[i].name, "placed");
    EXPECT_EQ(in.instances[i].hint.shell, true);
    EXPECT_EQ(in.instances[i].worldFromMesh, out.instances[i].worldFromMesh);
  }
  ASSERT_EQ(in.textures.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(in.textures[i].image.pixels(), out.textures[i].image.pixels());
    EXPECT_EQ(in.textures[i].wrapU, Wrap::MirroredRepeat);
    EXPECT_EQ(in.textures[i].wrapV, Wrap::ClampToEdge);
    EXPECT_TRUE(in.textures[i].magnifyNearest);
  }
}

TEST(GlbWriter, MaterialsComeBack) {
  const Scene in = importGltf(makeGlb(makeEverything()), {}, "everything.glb");
  const Material out = makeEverything().materials[0];
  const Material& m = in.materials.at(0);
  EXPECT_EQ(m.name, out.name);
  EXPECT_EQ(m.baseColor, out.baseColor);
  EXPECT_EQ(m.baseColorTexture.texture, 0);
  for (int column = 0; column < 3; ++column)
    EXPECT_LT(glm::distance(m.baseColorTexture.uvFromMesh[column], out.baseColorTexture.uvFromMesh[column]),
              1e-6f);
  EXPECT_EQ(m.metallic, out.metallic);
  EXPECT_EQ(m.roughness, out.roughness);
  EXPECT_EQ(m.occlusionTexture.texture, 1);
  EXPECT_EQ(m.occlusionTexture.uvSet, 1);
  EXPECT_EQ(m.occlusionStrength, out.occlusionStrength);
  EXPECT_LT(glm::distance(m.emissive, out.emissive), 1e-6f);
  EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(m.alphaCutoff, out.alphaCutoff);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.ior, out.ior);
  EXPECT_EQ(m.specular, out.specular);
  EXPECT_EQ(m.clearcoat, out.clearcoat);
  EXPECT_EQ(m.clearcoatRoughness, out.clearcoatRoughness);
  EXPECT_EQ(m.transmission, out.transmission);
  EXPECT_EQ(m.thickness, out.thickness);
  EXPECT_EQ(m.attenuationColor, out.attenuationColor);
  EXPECT_EQ(m.attenuationDistance, out.attenuationDistance);
  EXPECT_EQ(m.hint.reflector, true);
  EXPECT_EQ(m.hint.shape, "sphere");
  EXPECT_EQ(m.hint.reflectivity, 0.8f);
  EXPECT_TRUE(in.materials.at(1).unlit);
  EXPECT_EQ(in.materials.at(1).alphaMode, AlphaMode::Blend);
}

TEST(GlbWriter, LightsAndCamerasComeBack) {
  const Scene out = makeEverything(), in = importGltf(makeGlb(out), {}, "everything.glb");
  ASSERT_EQ(in.lights.size(), 1u);
  EXPECT_EQ(in.lights[0].type, LightType::Spot);
  EXPECT_LT(glm::distance(in.lights[0].color, out.lights[0].color), 1e-6f);
  EXPECT_LT(glm::distance(in.lights[0].position, out.lights[0].position), 1e-6f);
  EXPECT_LT(glm::distance(in.lights[0].direction, out.lights[0].direction), 1e-6f);
  EXPECT_EQ(in.lights[0].range, 9.0f);
  EXPECT_EQ(in.lights[0].innerConeRadians, 0.2f);
  EXPECT_EQ(in.lights[0].outerConeRadians, 0.5f);
  ASSERT_EQ(in.cameras.size(), 1u);
  EXPECT_EQ(in.cameras[0].name, "eye");
  EXPECT_LT(glm::distance(in.cameras[0].eye, out.cameras[0].eye), 1e-6);
  const dvec3 looksIn = glm::normalize(in.cameras[0].target - in.cameras[0].eye);
  const dvec3 looksOut = glm::normalize(out.cameras[0].target - out.cameras[0].eye);
  EXPECT_LT(glm::distance(looksIn, looksOut), 1e-6);
  EXPECT_NEAR(in.cameras[0].fovYRadians, 0.8, 1e-6);
}

TEST(GlbWriter, BytesDependOnTheSceneOnly) {
  EXPECT_EQ(makeGlb(makeEverything()), makeGlb(makeEverything()));
  Scene other = makeEverything();
  other.meshes[0].primitives[0].positions[1].x += 1e-6f;
  EXPECT_NE(makeGlb(makeEverything()), makeGlb(other));
}

TEST(GlbWriter, SharesMeshesAndSamplersAndDeclaresItsExtensions) {
  const nlohmann::json document = readDocument(makeGlb(makeEverything()));
  EXPECT_EQ(document["meshes"].size(), 1u);
  EXPECT_EQ(document["nodes"].size(), 4u);
  EXPECT_EQ(document["samplers"].size(), 1u);
  const auto used = document["extensionsUsed"].get<std::vector<std::string>>();
  EXPECT_EQ(used, (std::vector<std::string>{
                      "KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
                      "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
                      "KHR_materials_unlit", "KHR_materials_volume", "KHR_texture_transform"}));
  for (const auto& view : document["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<int>() % 4, 0);
}

TEST(GlbWriter, StoresLargeOpaqueTexturesAsJpegWhenAsked) {
  GlbOptions options;
  options.jpegFromPixels = 16;  // both textures are that large, but one is transparent
  const nlohmann::json document = readDocument(makeGlb(makeEverything(), options));
  EXPECT_EQ(document["images"][0]["mimeType"], "image/jpeg");
  EXPECT_EQ(document["images"][1]["mimeType"], "image/png");
}

TEST(GlbWriter, MovingInstancesComeBack) {
  Scene scene = makeEverything();
  MotionNode node;
  node.translation = {1, 2, 3};
  node.rotation = glm::angleAxis(0.5, dvec3(0, 1, 0));
  scene.motion.nodes = {node};
  scene.motion.order = {0};
  scene.instances.at(0).node = 0;
  scene.motion.animations = {{"slide", 2, {{.node = 0, .timesS = {0, 2}, .values = {1, 2, 3, 4, 5, 6}}}}};
  const Scene back = importGltf(makeGlb(scene), {}, "moving");
  ASSERT_EQ(back.motion.animations.size(), 1u);
  const Animation& animation = back.motion.animations[0];
  EXPECT_EQ(animation.name, "slide");
  EXPECT_EQ(animation.durationS, 2);
  ASSERT_EQ(animation.channels.size(), 1u);
  EXPECT_EQ(animation.channels[0].values, scene.motion.animations[0].channels[0].values);
  EXPECT_EQ(animation.channels[0].node, back.instances.at(0).node);
  EXPECT_EQ(dvec3(back.instances.at(0).worldFromMesh[3]), dvec3(1, 2, 3));
}

TEST(GlbWriter, EmptySceneIsAFileToo) {
  const Scene in = importGltf(makeGlb(Scene{}), {}, "empty.glb");
  EXPECT_TRUE(in.instances.empty());
}

}  // namespace
}  // namespace catoptric::scene
