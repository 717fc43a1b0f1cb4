// SPDX-License-Identifier: Apache-2.0
// A document that uses every feature, damaged at random: each damaged one is either refused with one line or
// gives a scene that keeps all promises. The seeds are fixed, so a failure can be repeated; tests/fuzz looks
// further.
#include <limits>
#include <map>
#include <random>

#include "catoptric/core/image_io.h"
#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

Document makeEverything() {
  Document d = makeTriangle();
  Json& primitive = d.json["meshes"][0]["primitives"][0];
  primitive["indices"] = d.addAccessor<std::uint16_t>({0, 1, 2, 0}, "SCALAR", 5123);
  primitive["mode"] = 5;
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = d.addFloats({0, 0, 1, 0, 0, 1}, "VEC2");
  primitive["attributes"]["TANGENT"] = d.addFloats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  primitive["attributes"]["COLOR_0"] = d.addFloats({1, 1, 1, 0, 0, 0, 1, 1, 1}, "VEC3");
  primitive["attributes"]["JOINTS_0"] =
      d.addAccessor<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5121);
  primitive["attributes"]["WEIGHTS_0"] = d.addFloats({0.5, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  primitive["targets"] = {{{"POSITION", d.addFloats({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3")}}};
  d.json["meshes"][0]["weights"] = {0.5};
  const int indexView = d.addView<std::uint8_t>({0, 2}), valueView = d.addView<float>({7, 8, 9, 10, 11, 12});
  d.json["accessors"][0]["sparse"] = {{"count", 2},
                                      {"indices", {{"bufferView", indexView}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", valueView}}}};
  d.addPrimitive({{"POSITION", 0}})["mode"] = 0;
  d.addPrimitive({{"POSITION", 0}})["mode"] = 2;
  d.addPrimitive({{"POSITION", 0}});
  const std::vector<std::byte> png = core::encodePng(core::ImageRgba8(2, 2, glm::u8vec4(9)));
  d.json["images"] = {{{"bufferView", d.addView(png)}, {"mimeType", "image/png"}}};
  d.json["samplers"] = {{{"wrapS", 33071}, {"minFilter", 9984}}};
  d.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const Json texture = {
      {"index", 0},
      {"extensions", {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1}, {"scale", {2, 2}}}}}}};
  d.json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", texture}, {"metallicFactor", 1}, {"roughnessFactor", 0}}},
       {"normalTexture", texture},
       {"emissiveFactor", {1, 1, 1}},
       {"alphaMode", "MASK"},
       {"extensions",
        {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1.4}}}}},
       {"extras", {{"catoptric", {{"reflector", true}, {"shape", "plane"}}}}}}};
  d.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}}};
  d.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}}}}, {{"type", "point"}}};
  d.json["extensionsUsed"] = {"KHR_lights_punctual", "EXT_mesh_gpu_instancing", "KHR_mesh_quantization"};
  const int copies = d.addFloats({1, 0, 0, 2, 0, 0}, "VEC3");
  const int inverse = d.addFloats(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
      "MAT4");
  d.json["skins"] = {{{"joints", {4, 5}}, {"inverseBindMatrices", inverse}, {"skeleton", 4}}};
  d.json["nodes"][0]["skin"] = 0;
  d.json["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = copies;
  d.json["nodes"].push_back({{"children", {5, 6}},
                             {"translation", {1, 2, 3}},
                             {"rotation", {0, 0, 0, 1}},
                             {"scale", {1, -1, 2}},
                             {"camera", 0}});
  d.json["nodes"].push_back({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, {"camera", 1}});
  d.json["nodes"].push_back(
      {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"mesh", 0}, {"weights", {1}}});
  d.json["scenes"] = {{{"nodes", {0, 1, 2, 3, 4}}, {"name", "all"}}};
  d.json["scene"] = 0;
  const int times = d.addFloats({0, 1}, "SCALAR");
  d.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", copies}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 4}, {"path", "translation"}}}}}}}};
  return d;
}

/// Fails the test unless the text is refused with one line or imported well. Returns whether it was imported.
bool checkImport(const std::string& text) {
  ImportOptions options;
  options.maxMemoryBytes = std::size_t(64) << 20;
  options.maxNodes = 1000;
  try {
    const Scene scene = import(text, options);
    const std::string fault = checkScene(scene);
    EXPECT_EQ(fault, "") << text.substr(0, 4000);
    return true;
  } catch (const core::Error& error) {
    EXPECT_TRUE(error.code().starts_with("gltf.")) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return false;
  }
}

/// Every value of a document once, leaves and containers, by pointer.
std::vector<Json::json_pointer> collectPointers(const Json& value) {
  std::map<std::string, Json::json_pointer> found;
  const Json flat = value.flatten();
  for (const auto& [pointer, leaf] : flat.items())
    for (Json::json_pointer p(pointer); !p.empty(); p.pop_back()) found.emplace(p.to_string(), p);
  std::vector<Json::json_pointer> out;
  out.reserve(found.size());
  for (const auto& [text, pointer] : found) out.push_back(pointer);
  return out;
}

Json oddValue(std::mt19937& random) {
  static const std::vector<Json> kOdd = {nullptr,
                                         -1,
                                         0,
                                         1,
                                         2,
                                         3,
                                         255,
                                         65535,
                                         4294967295u,
                                         1e20,
                                         -1e300,
                                         1e38,
                                         0.5,
                                         1e-40,
                                         9007199254740992ull,
                                         18446744073709551615ull,
                                         true,
                                         "",
                                         "x",
                                         "../x",
                                         "data:,",
                                         "2.0",
                                         Json::array(),
                                         Json::object(),
                                         Json::array({0}),
                                         Json::array({-1, 2}),
                                         5120,
                                         5121,
                                         5122,
                                         5123,
                                         5125,
                                         5126,
                                         "SCALAR",
                                         "VEC2",
                                         "VEC3",
                                         "VEC4",
                                         "MAT2",
                                         "MAT3",
                                         "MAT4",
                                         4,
                                         12,
                                         16,
                                         252};
  return kOdd[random() % kOdd.size()];
}

/// Mostly a number near the one that stood there, which gets further into the importer; else anything.
Json damagedValue(const Json& value, std::mt19937& random) {
  if (!value.is_number() || random() % 4 == 0) return oddValue(random);
  const double number = value.get<double>();
  const double choices[] = {number + 1, number - 1, number * 2, number / 2,
                            -number,    number + 4, number - 4, 0};
  return choices[random() % std::size(choices)];
}

TEST(GltfRobustness, TheUndamagedDocumentUsesEverything) {
  const Scene scene = import(makeEverything());
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_EQ(scene.instances.size(), 6u);
  EXPECT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.textures.size(), 1u);
}

TEST(GltfRobustness, TwoImportsGiveTheSameScene) {
  const Document document = makeEverything();
  const Scene a = import(document), b = import(document);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    ASSERT_EQ(a.meshes[m].primitives.size(), b.meshes[m].primitives.size());
    for (std::size_t p = 0; p < a.meshes[m].primitives.size(); ++p) {
      EXPECT_EQ(a.meshes[m].primitives[p].positions, b.meshes[m].primitives[p].positions);
      EXPECT_EQ(a.meshes[m].primitives[p].normals, b.meshes[m].primitives[p].normals);
      EXPECT_EQ(a.meshes[m].primitives[p].indices, b.meshes[m].primitives[p].indices);
    }
  }
  EXPECT_EQ(a.warnings, b.warnings);
}

TEST(GltfRobustness, EachValueReplacedByAnOddOne) {
  const Json original = Json::parse(makeEverything().text());
  const std::vector<Json::json_pointer> pointers = collectPointers(original);
  std::mt19937 random(1);
  std::size_t imported = 0;
  for (int round = 0; round < 2500; ++round) {
    Json damaged = original;
    for (std::size_t change = 0; change <= random() % 2; ++change) {
      const Json::json_pointer& pointer = pointers[random() % pointers.size()];
      if (damaged.contains(pointer)) damaged[pointer] = damagedValue(damaged[pointer], random);
    }
    imported += checkImport(damaged.dump()) ? 1 : 0;
  }
  EXPECT_GT(imported, 250u) << "the damage is too gross to get past the first check";
  EXPECT_LT(imported, 2250u);
}

TEST(GltfRobustness, EachMemberRemoved) {
  const Json original = Json::parse(makeEverything().text());
  const std::vector<Json::json_pointer> pointers = collectPointers(original);
  for (const Json::json_pointer& pointer : pointers) {
    Json damaged = original;
    Json& parent = damaged[pointer.parent_pointer()];
    if (parent.is_object())
      parent.erase(pointer.back());
    else
      parent.erase(std::size_t(std::stoul(pointer.back())));
    checkImport(damaged.dump());
  }
}

TEST(GltfRobustness, BytesOfTheGeometryReplaced) {
  Document document = makeEverything();
  const std::vector<std::byte> original = document.bytes();
  std::mt19937 random(2);
  for (int round = 0; round < 1500; ++round) {
    document.bytes() = original;
    for (std::size_t change = 0; change <= random() % 8; ++change) {
      const std::size_t at = random() % original.size();
      document.bytes()[at] = std::byte(random() % 3 == 0 ? 0xFF : random() % 256);
      // Now and then a whole NaN or infinity.
      if (random() % 4 == 0 && at + 4 <= original.size()) {
        const float value = random() % 2 == 0 ? std::numeric_limits<float>::infinity()
                                              : std::numeric_limits<float>::quiet_NaN();
        std::memcpy(&document.bytes()[at / 4 * 4], &value, 4);
      }
    }
    checkImport(document.text());
  }
}

TEST(GltfRobustness, BytesOfTheTextReplacedOrCutOff) {
  const std::string original = makeEverything().text();
  std::mt19937 random(3);
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = original;
    for (std::size_t change = 0; change <= random() % 3; ++change)
      damaged[random() % damaged.size()] = "0123456789-.,:{}[]\"eE \xFF"[random() % 22];
    if (random() % 8 == 0) damaged.resize(random() % damaged.size());
    checkImport(damaged);
  }
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
