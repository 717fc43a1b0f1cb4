// SPDX-License-Identifier: Apache-2.0
// Materials, textures, samplers, their extensions.
#include "catoptric/core/image_io.h"
#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

std::string makePngUri(const glm::u8vec4& color) {
  const std::vector<std::byte> png = core::encodePng(core::ImageRgba8(2, 2, color));
  return "data:image/png;base64," + encodeBase64(png);
}

Document withMaterial(const Json& material) {
  Document document = makeTriangle();
  document.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      document.addFloats({0, 0, 1, 0, 0, 1}, "VEC2");
  document.json["meshes"][0]["primitives"][0]["material"] = 0;
  document.json["materials"] = {material};
  document.json["images"] = {{{"uri", makePngUri({255, 0, 0, 255})}},
                             {{"uri", makePngUri({0, 255, 0, 255})}}};
  document.json["textures"] = {
      {{"source", 0}}, {{"source", 1}}, {{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
  document.json["samplers"] = {
      {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9984}}};
  return document;
}

TEST(GltfMaterial, EveryCoreMember) {
  const Scene scene = import(withMaterial({{"name", "paint"},
                                           {"pbrMetallicRoughness",
                                            {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                             {"metallicFactor", 0.5},
                                             {"roughnessFactor", 0.25},
                                             {"baseColorTexture", {{"index", 0}}},
                                             {"metallicRoughnessTexture", {{"index", 1}}}}},
                                           {"normalTexture", {{"index", 1}, {"scale", 0.7}}},
                                           {"occlusionTexture", {{"index", 1}, {"strength", 0.6}}},
                                           {"emissiveTexture", {{"index", 2}}},
                                           {"emissiveFactor", {1, 0.5, 0}},
                                           {"alphaMode", "MASK"},
                                           {"alphaCutoff", 0.3},
                                           {"doubleSided", true},
                                           {"extras", {{"catoptric", {{"reflector", false}}}}}}));
  EXPECT_EQ(checkScene(scene), "");
  ASSERT_EQ(scene.materials.size(), 2u);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(m.baseColor, vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.25f);
  EXPECT_EQ(m.normalScale, 0.7f);
  EXPECT_EQ(m.occlusionStrength, 0.6f);
  EXPECT_EQ(m.emissive, vec3(1, 0.5f, 0));
  EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(m.alphaCutoff, 0.3f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.hint.reflector, false);
  EXPECT_EQ(scene.textures.size(), 2u) << "textures of one image and sampler are one";
  EXPECT_EQ(m.baseColorTexture.texture, m.emissiveTexture.texture);
  EXPECT_EQ(scene.textures[std::size_t(m.metallicRoughnessTexture.texture)].image.at(0, 0),
            glm::u8vec4(0, 255, 0, 255));
}

TEST(GltfMaterial, WithoutOneTheDefaultIsUsed) {
  const Scene scene = import(makeTriangle());
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.meshes[0].primitives[0].material, 0);
  EXPECT_EQ(scene.materials[0].metallic, 1.0f);
  EXPECT_EQ(scene.materials[0].roughness, 1.0f);
}

TEST(GltfMaterial, Samplers) {
  const Scene scene =
      import(withMaterial({{"normalTexture", {{"index", 3}}}, {"emissiveTexture", {{"index", 0}}}}));
  ASSERT_EQ(scene.textures.size(), 2u);
  const Texture& texture = scene.textures[std::size_t(scene.materials[0].normalTexture.texture)];
  EXPECT_EQ(texture.wrapU, Wrap::ClampToEdge);
  EXPECT_EQ(texture.wrapV, Wrap::MirroredRepeat);
  EXPECT_TRUE(texture.magnifyNearest);
  EXPECT_TRUE(texture.minifyNearest);
  EXPECT_TRUE(texture.useMipmaps);
  const Texture& plain = scene.textures[std::size_t(scene.materials[0].emissiveTexture.texture)];
  EXPECT_EQ(plain.image.pixels(), texture.image.pixels());
  EXPECT_EQ(plain.wrapU, Wrap::Repeat);
  for (const char* key : {"wrapS", "wrapT", "magFilter", "minFilter"}) {
    Document document = withMaterial(Json::object());
    document.json["samplers"][0][key] = 9999;
    EXPECT_REFUSED(document, "gltf.value", std::string("/samplers/0/") + key);
  }
}

TEST(GltfMaterial, Extensions) {
  const Scene scene = import(withMaterial(
      {{"emissiveFactor", {1, 0, 0}},
       {"extensions",
        {{"KHR_materials_unlit", Json::object()},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
         {"KHR_materials_ior", {{"ior", 0}}},
         {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {2, 1, 0}}}},
         {"KHR_materials_clearcoat",
          {{"clearcoatFactor", 0.75},
           {"clearcoatRoughnessFactor", 0.125},
           {"clearcoatTexture", {{"index", 0}}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 0.25},
           {"thicknessTexture", {{"index", 0}}},
           {"attenuationDistance", 3},
           {"attenuationColor", {0.5, 0.25, 1}}}}}}}));
  const Material& m = scene.materials[0];
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.emissive, vec3(5, 0, 0));
  EXPECT_EQ(m.ior, 0.0f);
  EXPECT_EQ(m.specular, 0.5f);
  EXPECT_EQ(m.specularColor, vec3(2, 1, 0));
  EXPECT_EQ(m.clearcoat, 0.75f);
  EXPECT_EQ(m.clearcoatRoughness, 0.125f);
  EXPECT_EQ(m.transmission, 0.5f);
  EXPECT_EQ(m.thickness, 0.25f);
  EXPECT_EQ(m.attenuationDistance, 3.0f);
  EXPECT_EQ(m.attenuationColor, vec3(0.5f, 0.25f, 1));
  EXPECT_FALSE(hasWarning(scene, "thicknessTexture")) << "the way inside is measured, not looked up";
  EXPECT_TRUE(hasWarning(scene, "clearcoatTexture"));
}

TEST(GltfMaterial, RangesAndTypes) {
  const auto pbr = [](const char* key, const Json& value) {
    return withMaterial({{"pbrMetallicRoughness", {{key, value}}}});
  };
  EXPECT_REFUSED(pbr("metallicFactor", 1.5), "gltf.value",
                 "/materials/0/pbrMetallicRoughness/metallicFactor");
  EXPECT_REFUSED(pbr("roughnessFactor", "0"), "gltf.type",
                 "/materials/0/pbrMetallicRoughness/roughnessFactor");
  EXPECT_REFUSED(pbr("baseColorFactor", Json({1, 1, 1})), "gltf.value",
                 "/materials/0/pbrMetallicRoughness/baseColorFactor");
  EXPECT_REFUSED(pbr("baseColorFactor", Json({1, 1, -1, 1})), "gltf.value",
                 "/materials/0/pbrMetallicRoughness/baseColorFactor/2");
  EXPECT_REFUSED(pbr("baseColorTexture", Json({{"index", 4}})), "gltf.index_out_of_range",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture/index");
  EXPECT_REFUSED(pbr("baseColorTexture", Json::object()), "gltf.missing",
                 "/materials/0/pbrMetallicRoughness/baseColorTexture");
  EXPECT_REFUSED(withMaterial({{"alphaMode", "GLASS"}}), "gltf.value", "/materials/0/alphaMode");
  EXPECT_REFUSED(withMaterial({{"doubleSided", 1}}), "gltf.type", "/materials/0/doubleSided");
  EXPECT_REFUSED(withMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}}), "gltf.value",
                 "/materials/0/extensions/KHR_materials_ior/ior");
}

TEST(GltfMaterial, TextureTransformIsTranslationTimesRotationTimesScale) {
  const Scene scene = import(withMaterial({{"normalTexture",
                                            {{"index", 0},
                                             {"texCoord", 1},
                                             {"extensions",
                                              {{"KHR_texture_transform",
                                                {{"offset", {0.5, 0.25}},
                                                 {"rotation", glm::half_pi<double>()},
                                                 {"scale", {2, 3}},
                                                 {"texCoord", 0}}}}}}}}));
  const TextureSlot& slot = scene.materials[0].normalTexture;
  EXPECT_EQ(slot.uvSet, 0);
  // A quarter turn counter-clockwise as seen in the image (v down): u goes to -v, v goes to u.
  const vec3 u = slot.uvFromMesh * vec3(1, 0, 1), v = slot.uvFromMesh * vec3(0, 1, 1);
  EXPECT_NEAR(u.x, 0.5f, 1e-6f);
  EXPECT_NEAR(u.y, 0.25f - 2.0f, 1e-6f);
  EXPECT_NEAR(v.x, 0.5f + 3.0f, 1e-6f);
  EXPECT_NEAR(v.y, 0.25f, 1e-6f);
}

TEST(GltfMaterial, TexCoordSetsBeyondOneAreIgnoredAndMissingOnesWarn) {
  const Scene scene = import(withMaterial({{"normalTexture", {{"index", 0}, {"texCoord", 2}}},
                                           {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}}));
  EXPECT_EQ(scene.materials[0].normalTexture.texture, -1);
  EXPECT_TRUE(hasWarning(scene, "TEXCOORD_2"));
  EXPECT_TRUE(hasWarning(scene, "no TEXCOORD_1"));
}

TEST(GltfTextures, WebpIsPreferredAndBasisuFallsBack) {
  Document document = withMaterial({{"normalTexture", {{"index", 0}}}});
  document.json["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", 1}}},
                                                {"KHR_texture_basisu", {{"source", 0}}}};
  const Scene scene = import(document);
  EXPECT_EQ(scene.textures.at(0).image.at(0, 0), glm::u8vec4(0, 255, 0, 255));
  document.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  const Scene without = import(document);
  EXPECT_EQ(without.materials[0].normalTexture.texture, -1);
  EXPECT_TRUE(hasWarning(without, "no image in a format"));
}

TEST(GltfTextures, ImagesInBufferViewsAndTheirRules) {
  Document document = withMaterial({{"normalTexture", {{"index", 0}}}});
  const int view = document.addView(core::encodePng(core::ImageRgba8(3, 2, glm::u8vec4(1, 2, 3, 255))));
  document.json["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}};
  EXPECT_EQ(import(document).textures.at(0).image.width(), 3);
  document.json["images"][0].erase("mimeType");
  EXPECT_REFUSED(document, "gltf.missing", "/images/0");
  document.json["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}, {"uri", "a.png"}};
  EXPECT_REFUSED(document, "gltf.value", "/images/0");
  document.json["images"][0] = Json::object();
  EXPECT_REFUSED(document, "gltf.value", "/images/0");
}

TEST(GltfTextures, DamagedAndHugeImagesAreRefused) {
  Document document = withMaterial({{"normalTexture", {{"index", 0}}}});
  document.json["images"][0]["uri"] = "data:image/png;base64,iVBORw0KGgo=";
  EXPECT_REFUSED(document, "gltf.image", "/images/0");
  Document large = withMaterial({{"normalTexture", {{"index", 0}}}});
  ImportOptions options;
  options.maxPixels = 3;
  const auto error = importError(large, options);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), "gltf.image");
  EXPECT_EQ(error->pointer(), "/images/0");
}

TEST(GltfTextures, UnusedImagesAreNotReadButTheirUrisAreChecked) {
  Document document = withMaterial(Json::object());
  document.json["images"][0]["uri"] = "data:image/png;base64,AAAA";
  document.json["images"][1]["uri"] = "missing.png";
  EXPECT_TRUE(import(document).textures.empty());
  document.json["images"][1]["uri"] = "../missing.png";
  EXPECT_REFUSED(document, "gltf.uri", "/images/1/uri");
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
