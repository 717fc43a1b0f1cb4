// SPDX-License-Identifier: Apache-2.0
// The container, JSON, versions, extensions, the checked getters, the limits.
#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

std::string makeGlb(std::string json, const std::string& binary, std::uint32_t binaryType = 0x004E4942) {
  while (json.size() % 4 != 0) json += ' ';
  const auto word = [](std::uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
  std::string body = word(std::uint32_t(json.size())) + word(0x4E4F534A) + json;
  if (!binary.empty()) body += word(std::uint32_t(binary.size())) + word(binaryType) + binary;
  return "glTF" + word(2) + word(std::uint32_t(12 + body.size())) + body;
}

/// The triangle with its bytes in a BIN chunk.
std::string makeTriangleGlb(std::uint32_t binaryType = 0x004E4942) {
  Document document = makeTriangle();
  document.json["buffers"] = {{{"byteLength", document.bytes().size()}}};
  const std::string binary(reinterpret_cast<const char*>(document.bytes().data()), document.bytes().size());
  return makeGlb(document.text(), binary, binaryType);
}

TEST(GltfContainer, ReadsAGlbFromMemory) {
  const Scene scene = import(makeTriangleGlb());
  EXPECT_EQ(checkScene(scene), "");
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.meshes[0].primitives[0].indices.size(), 3u);
}

TEST(GltfContainer, RefusesEveryTruncation) {
  const std::string glb = makeTriangleGlb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    const auto error = importError(glb.substr(0, size));
    ASSERT_TRUE(error);
    EXPECT_TRUE(error->code() == "gltf.glb" || error->code() == "gltf.json") << size << ": " << error->what();
  }
}

TEST(GltfContainer, BytesAfterTheEndAreIgnoredWithAWarning) {
  EXPECT_TRUE(hasWarning(import(makeTriangleGlb() + "tail"), "4 bytes after the end"));
}

TEST(GltfContainer, RefusesOtherVersionsAndUnknownBinary) {
  std::string glb = makeTriangleGlb();
  glb[4] = 1;
  EXPECT_EQ(importError(glb)->code(), "gltf.version");
  // The chunk of unknown type is skipped, so the buffer has no data.
  EXPECT_EQ(importError(makeTriangleGlb(0x12345678))->code(), "gltf.buffer_size");
}

TEST(GltfJson, DepthIsBoundedAndCostsNoStack) {
  for (const std::size_t depth : {std::size_t(300), std::size_t(2000000)}) {
    const std::string deep =
        R"({"asset":{"version":"2.0"},"extras":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
    EXPECT_EQ(importError(deep)->code(), "gltf.json");
  }
}

TEST(GltfJson, RefusesDuplicateKeysAndBadText) {
  EXPECT_EQ(importError(R"({"asset":{"version":"2.0"},"asset":{"version":"2.0"}})")->code(), "gltf.json");
  EXPECT_EQ(importError(R"({"asset":{"version":"2.0","version":"2.0"}})")->code(), "gltf.json");
  for (const char* text : {"", "null", "[]", "{", "{\"asset\":1e999}", "\xff\xfe{}", "glTF"}) {
    const auto error = importError(std::string(text));
    ASSERT_TRUE(error);
    EXPECT_TRUE(error->code().starts_with("gltf.")) << text;
  }
}

TEST(GltfJson, ByteOrderMarkIsSkippedWithAWarning) {
  EXPECT_TRUE(hasWarning(import("\xEF\xBB\xBF"
                                R"({"asset":{"version":"2.0"}})"),
                         "byte order mark"));
}

TEST(GltfJson, AnEmptyAssetIsAnEmptyScene) {
  const Scene scene = import(std::string(R"({"asset":{"version":"2.0"}})"));
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_TRUE(scene.instances.empty());
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].roughness, 1.0f);
  EXPECT_TRUE(hasWarning(scene, "nothing to draw"));
}

TEST(GltfVersion, OnlyTwo) {
  for (const char* version : {"1.0", "3.0", "2", "2.", "2.0.1", "two", "-2.0"}) {
    Document document;
    document.json["asset"]["version"] = version;
    EXPECT_REFUSED(document, "gltf.version", "/asset/version");
  }
  Document newer = makeTriangle();
  newer.json["asset"]["version"] = "2.1";
  EXPECT_EQ(checkScene(import(newer)), "");
  newer.json["asset"]["minVersion"] = "2.1";
  EXPECT_REFUSED(newer, "gltf.version", "/asset/minVersion");
  Document number;
  number.json["asset"]["version"] = 2.0;
  EXPECT_REFUSED(number, "gltf.type", "/asset/version");
}

TEST(GltfExtensions, RequiredOnesAreNamedOptionalOnesWarn) {
  Document document = makeTriangle();
  document.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  EXPECT_TRUE(hasWarning(import(document), "KHR_draco_mesh_compression"));
  document.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_draco_mesh_compression"};
  const auto error = importError(document);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), "gltf.extension_required");
  EXPECT_EQ(error->pointer(), "/extensionsRequired/1");
  EXPECT_NE(std::string(error->what()).find("KHR_draco_mesh_compression"), std::string::npos);
}

TEST(GltfGetters, IntegersAreCheckedBeforeTheyAreConverted) {
  for (const Json& bad : {Json(-1), Json(0.5), Json(1e20), Json(-1e300), Json(18446744073709551615ull),
                          Json("0"), Json(nullptr), Json(true), Json::array({0}), Json(1)}) {
    Document document = makeTriangle();
    document.json["nodes"][0]["mesh"] = bad;
    const auto error = importError(document);
    ASSERT_TRUE(error) << bad;
    EXPECT_EQ(error->pointer(), "/nodes/0/mesh") << bad;
  }
  Document whole = makeTriangle();
  whole.json["nodes"][0]["mesh"] = 0.0;
  EXPECT_EQ(import(whole).instances.size(), 1u);
}

TEST(GltfErrors, AreOneLineWithThePointerAndNoControlCharacters) {
  Document document = makeTriangle();
  document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7;
  const auto error = importError(document);
  ASSERT_TRUE(error);
  EXPECT_STREQ(
      error->what(),
      "test.gltf: there is no accessor 7, the file has 2 (at /meshes/0/primitives/0/attributes/POSITION)");
  Document hostile;
  hostile.json["extensionsRequired"] = {"evil\n\x1b[31m~/"};
  const std::string line = importError(hostile)->what();
  EXPECT_EQ(line.find_first_of("\n\x1b"), std::string::npos);
}

TEST(GltfErrors, SaysWhatIsMissingOfATruncatedBuffer) {
  Document document = makeTriangle();
  document.json["accessors"][0]["count"] = 8;
  const auto error = importError(document);
  ASSERT_TRUE(error);
  EXPECT_STREQ(error->what(),
               "test.gltf: accessor reaches byte 96 of a buffer view that holds 36 (at /accessors/0); the "
               "file is damaged or was cut short");
}

TEST(GltfLimits, MemoryIsRefusedBeforeItIsAllocated) {
  Document zeros;  // an accessor without a buffer view is all zeros: a line of JSON, gigabytes of memory
  zeros.json["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 1000000000}}};
  zeros.addPrimitive({{"POSITION", 0}});
  EXPECT_EQ(importError(zeros)->code(), "gltf.memory");

  ImportOptions small;
  small.maxMemoryBytes = 1 << 20;
  Document dense = makeTriangle();
  dense.json["extras"] = std::vector<int>(100000, 1);
  EXPECT_EQ(importError(dense, small)->code(), "gltf.memory");
}

TEST(GltfLimits, InstancingCountsAgainstTheBudget) {
  Document document;
  std::vector<float> positions;
  for (int i = 0; i < 3000; ++i) positions.insert(positions.end(), {float(i), float(i % 7), float(i % 11)});
  document.addPrimitive({{"POSITION", document.addFloats(positions, "VEC3")}});
  for (int i = 0; i < 1000; ++i) document.json["nodes"].push_back({{"mesh", 0}});
  ImportOptions options;
  options.maxMemoryBytes = std::size_t(64) << 20;
  EXPECT_EQ(importError(document, options)->code(), "gltf.memory");
  EXPECT_EQ(import(document).instances.size(), 1001u);
}

TEST(GltfLimits, Nodes) {
  Document document = makeTriangle();
  for (int i = 0; i < 10; ++i) document.json["nodes"].push_back(Json::object());
  ImportOptions options;
  options.maxNodes = 10;
  const auto error = importError(document, options);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), "gltf.nodes");
  options.maxNodes = 11;
  EXPECT_EQ(checkScene(import(document, options)), "");
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
