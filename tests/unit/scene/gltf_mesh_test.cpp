// SPDX-License-Identifier: Apache-2.0
// Geometry: modes and their winding, formats, repairs, points and lines, morph targets, skins.
#include <limits>
#include <map>

#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

const MeshPrimitive& first(const Scene& scene) {
  return scene.meshes.at(0).primitives.at(0);
}

vec3 faceNormal(const MeshPrimitive& p, std::size_t triangle) {
  const vec3 a = p.positions[p.indices[3 * triangle]], b = p.positions[p.indices[3 * triangle + 1]],
             c = p.positions[p.indices[3 * triangle + 2]];
  return glm::cross(b - a, c - a);
}

/// Two rows of five points each in the plane z = 0; consecutive pairs make a strip.
Document makeGrid(int mode, const std::vector<std::uint16_t>& indices) {
  Document document;
  std::vector<float> positions;
  for (int i = 0; i < 5; ++i)
    for (const float y : {1.0f, 0.0f}) positions.insert(positions.end(), {float(i), y, 0});
  Json& primitive = document.addPrimitive({{"POSITION", document.addFloats(positions, "VEC3")}});
  primitive["mode"] = mode;
  if (!indices.empty()) primitive["indices"] = document.addAccessor(indices, "SCALAR", 5123);
  return document;
}

TEST(GltfMesh, StripsAndFansKeepTheirWinding) {
  for (const Document& document : {makeGrid(5, {}), makeGrid(5, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}),
                                   makeGrid(6, {1, 3, 5, 7, 9, 8, 6, 4, 2, 0})}) {
    const Scene scene = import(document);
    EXPECT_EQ(checkScene(scene), "");
    double area = 0;
    for (std::size_t i = 0; i < first(scene).indices.size() / 3; ++i) {
      EXPECT_GT(faceNormal(first(scene), i).z, 0.0f);
      area += 0.5 * faceNormal(first(scene), i).z;
    }
    EXPECT_NEAR(area, 4.0, 1e-6);
  }
}

TEST(GltfMesh, JoinsOfStripsAreNoFault) {
  const Scene scene = import(makeGrid(5, {0, 1, 2, 3, 3, 6, 6, 7, 8, 9}));
  EXPECT_EQ(first(scene).indices.size() / 3, 4u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMesh, LeftoverVerticesAndDegenerateTrianglesAreCounted) {
  const Scene scene = import(makeGrid(4, {0, 1, 2, 0, 2, 4, 1, 1, 2, 3, 4}));
  EXPECT_EQ(first(scene).indices.size() / 3, 1u);
  EXPECT_TRUE(hasWarning(scene, "2 triangles of zero area"));
  EXPECT_TRUE(hasWarning(scene, "2 vertices at the end"));
  EXPECT_EQ(first(scene).positions.size(), 3u) << "unused vertices stay";
}

TEST(GltfMesh, IndicesAreChecked) {
  EXPECT_REFUSED(makeGrid(4, {0, 1, 10}), "gltf.index_out_of_range", "/meshes/0/primitives/0/indices");
  EXPECT_REFUSED(makeGrid(5, {0, 1, 65535}), "gltf.accessor_data", "/meshes/0/primitives/0/indices");
  Document mode = makeGrid(7, {});
  EXPECT_REFUSED(mode, "gltf.value", "/meshes/0/primitives/0/mode");
  Document floats = makeTriangle();
  floats.json["meshes"][0]["primitives"][0]["indices"] = 0;
  EXPECT_REFUSED(floats, "gltf.accessor_format", "/meshes/0/primitives/0/indices");
  Document strided = makeGrid(4, {0, 1, 2});
  strided.json["bufferViews"][1]["byteStride"] = 4;
  EXPECT_EQ(importError(strided)->code().substr(0, 14), "gltf.accessor_");
}

TEST(GltfMesh, MissingNormalsAreFlatAndSplitTheVertices) {
  Document document;
  const int position = document.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  const int color = document.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
  Json& primitive = document.addPrimitive({{"POSITION", position}, {"COLOR_0", color}});
  primitive["indices"] = document.addAccessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5121);
  const Scene scene = import(document);
  EXPECT_EQ(checkScene(scene), "");
  const MeshPrimitive& p = first(scene);
  ASSERT_EQ(p.positions.size(), 6u);
  EXPECT_EQ(p.normals[0], vec3(0, 0, 1));
  EXPECT_EQ(p.normals[3], vec3(1, 0, 0));
  EXPECT_EQ(p.colors[1], vec4(0, 1, 0, 1));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMesh, BadNormalsAreRecomputedAndCounted) {
  Document document;
  const int position = document.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normal = document.addFloats({0, 0, 0, kNan, 0, 1, 0, 0, 5}, "VEC3");
  document.addPrimitive({{"POSITION", position}, {"NORMAL", normal}});
  const Scene scene = import(document);
  EXPECT_EQ(checkScene(scene), "");
  for (const vec3& n : first(scene).normals) EXPECT_EQ(n, vec3(0, 0, 1));
  EXPECT_TRUE(hasWarning(scene, "2 normals were zero or not finite"));
  EXPECT_TRUE(hasWarning(scene, "1 normals were more than 10 %"));
}

TEST(GltfMesh, NonFiniteAndHugePositionsDropTheirTrianglesOnly) {
  for (const float bad : {kNan, kInfinity, -kInfinity, 1e30f, 3e38f}) {
    Document document;
    const int position = document.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, bad, 0, 0, 0, 1}, "VEC3");
    document.addPrimitive({{"POSITION", position}});
    const Scene scene = import(document);
    EXPECT_EQ(checkScene(scene), "") << bad;
    EXPECT_EQ(first(scene).indices.size(), 3u);
    EXPECT_TRUE(hasWarning(scene, std::isfinite(bad) ? "1 triangles, lines or points beyond 1e15"
                                                     : "1 triangles, lines or points with NaN"));
  }
}

TEST(GltfMesh, ExtremeButUsableScalesGiveUnitNormals) {
  for (const float scale : {1e-30f, 1e-12f, 1e12f, 9e14f}) {
    Document document;
    document.addPrimitive({{"POSITION", document.addFloats({0, 0, 0, scale, 0, 0, 0, scale, 0}, "VEC3")}});
    const Scene scene = import(document);
    EXPECT_EQ(checkScene(scene), "") << scale;
    EXPECT_EQ(first(scene).normals[0], vec3(0, 0, 1)) << scale;
  }
}

TEST(GltfMesh, OtherAttributesAreRepairedAndCounted) {
  Document document = makeTriangle();
  Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TANGENT"] = document.addFloats({1, 0, 0, 1, 0, 0, 0, -1, 0, 2, 0, 0}, "VEC4");
  attributes["TEXCOORD_0"] = document.addFloats({0, 0, kNan, 0, kInfinity, 1}, "VEC2");
  attributes["COLOR_0"] = document.addFloats({0.5f, 1.5f, 0, -1, 0, 0, 0, kNan, 1}, "VEC3");
  const Scene scene = import(document);
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_TRUE(hasWarning(scene, "2 tangents"));
  EXPECT_TRUE(hasWarning(scene, "2 texture coordinates"));
  EXPECT_TRUE(hasWarning(scene, "3 vertex colours"));
  EXPECT_EQ(first(scene).tangents[1].w, -1.0f);
  EXPECT_EQ(first(scene).colors[0], vec4(0.5f, 1, 0, 1));
}

TEST(GltfMesh, QuantizedAttributesNeedTheirExtension) {
  Document document;
  const int position =
      document.addAccessor<std::int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0}, "VEC4", 5122);
  document.json["accessors"][0]["type"] = "VEC3";
  document.json["accessors"][0]["count"] = 3;
  document.json["bufferViews"][0]["byteStride"] = 8;
  document.addPrimitive({{"POSITION", position}});
  EXPECT_REFUSED(document, "gltf.accessor_format", "/meshes/0/primitives/0/attributes/POSITION");
  document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(first(import(document)).positions[1], vec3(100, 0, 0));
  document.json["accessors"][0]["normalized"] = true;
  EXPECT_NEAR(first(import(document)).positions[1].x, 100.0f / 32767.0f, 1e-7f);
}

TEST(GltfMesh, FormatsAndCountsOfAttributes) {
  const auto withAttribute = [](const char* semantic, int (*add)(Document&)) {
    Document document = makeTriangle();
    document.json["meshes"][0]["primitives"][0]["attributes"][semantic] = add(document);
    return document;
  };
  const auto pointer = [](const char* semantic) {
    return std::string("/meshes/0/primitives/0/attributes/") + semantic;
  };
  EXPECT_REFUSED(withAttribute("TEXCOORD_0",
                               [](Document& d) {
                                 return d.addFloats({0, 0, 1, 1}, "VEC2");
                               }),
                 "gltf.accessor_format", pointer("TEXCOORD_0"));
  EXPECT_REFUSED(withAttribute("TEXCOORD_0",
                               [](Document& d) {
                                 return d.addFloats({0, 0, 1}, "SCALAR");
                               }),
                 "gltf.accessor_format", pointer("TEXCOORD_0"));
  EXPECT_REFUSED(
      withAttribute("TANGENT", [](Document& d) { return d.addFloats(std::vector<float>(9, 1), "VEC3"); }),
      "gltf.accessor_format", pointer("TANGENT"));
  EXPECT_REFUSED(withAttribute("_CUSTOM",
                               [](Document& d) {
                                 return d.addAccessor<std::uint32_t>({0, 1, 2}, "SCALAR", 5125);
                               }),
                 "gltf.accessor_format", pointer("_CUSTOM"));
  EXPECT_REFUSED(withAttribute("JOINTS_0",
                               [](Document& d) {
                                 return d.addAccessor<std::uint8_t>(std::vector<std::uint8_t>(12), "VEC4",
                                                                    5121);
                               }),
                 "gltf.value", "/meshes/0/primitives/0/attributes");
  const Scene scene = import(withAttribute("TEXCOORD_00", [](Document& d) {
    return d.addFloats({0, 0, 1, 1, 1, 1}, "VEC2");
  }));
  EXPECT_TRUE(hasWarning(scene, "TEXCOORD_00"));
  EXPECT_TRUE(first(scene).uv[0].empty());
}

TEST(GltfMesh, NoPositionMeansNothingToDraw) {
  Document document = makeTriangle();
  document.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
  const Scene scene = import(document);
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(hasWarning(scene, "no POSITION"));
}

/// Volume of a closed mesh; positive if its faces look outwards.
double signedVolume(const MeshPrimitive& p) {
  double volume = 0;
  for (std::size_t i = 0; i < p.indices.size(); i += 3)
    volume += glm::dot(dvec3(p.positions[p.indices[i]]), glm::cross(dvec3(p.positions[p.indices[i + 1]]),
                                                                    dvec3(p.positions[p.indices[i + 2]]))) /
              6;
  return volume;
}

/// True if each edge is used once in each direction.
bool isClosed(const MeshPrimitive& p) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < p.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{p.indices[i + k], p.indices[i + (k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto twin = edges.find({edge.second, edge.first});
    if (count != 1 || twin == edges.end() || twin->second != 1) return false;
  }
  return true;
}

TEST(GltfMesh, PointsBecomeOctahedra) {
  const Scene scene = import(makeGrid(0, {}));
  EXPECT_EQ(checkScene(scene), "");
  const MeshPrimitive& p = first(scene);
  EXPECT_EQ(p.indices.size() / 3, 80u);
  EXPECT_TRUE(isClosed(p));
  const double radius = 0.002 * 0.5 * std::sqrt(17.0);
  EXPECT_NEAR(signedVolume(p), 10 * 4.0 / 3.0 * radius * radius * radius, 1e-3 * signedVolume(p));
}

TEST(GltfMesh, LinesBecomePrisms) {
  const double radius = 0.002 * 0.5 * std::sqrt(17.0), section = 0.75 * std::sqrt(3.0) * radius * radius;
  struct Case {
    int mode;
    std::vector<std::uint16_t> indices;
    std::size_t segments;
    double length;
  };
  for (const Case& c :
       {Case{1, {0, 2, 1, 9}, 2, 1 + 4}, Case{3, {0, 2, 4, 6}, 3, 3}, Case{2, {0, 1, 3, 2}, 4, 4}}) {
    const Scene scene = import(makeGrid(c.mode, c.indices));
    EXPECT_EQ(checkScene(scene), "");
    EXPECT_EQ(first(scene).indices.size() / 3, 8 * c.segments);
    EXPECT_TRUE(isClosed(first(scene)));
    EXPECT_NEAR(signedVolume(first(scene)), section * c.length, 1e-3 * section * c.length) << c.mode;
  }
}

TEST(GltfMesh, MorphTargetsApplyTheirDefaultWeights) {
  Document document = makeTriangle();
  Json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["targets"] = {{{"POSITION", document.addFloats({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3")}}};
  EXPECT_EQ(first(import(document)).positions[0].z, 0.0f);
  document.json["meshes"][0]["weights"] = {0.5};
  const Scene byMesh = import(document);
  EXPECT_EQ(first(byMesh).positions[0].z, 1.0f);
  document.json["nodes"].push_back({{"mesh", 0}, {"weights", {1.5}}});
  document.json["nodes"].push_back({{"mesh", 0}});
  const Scene byNode = import(document);
  ASSERT_EQ(byNode.meshes.size(), 2u);
  EXPECT_EQ(byNode.meshes[1].primitives[0].positions[0].z, 3.0f);
  EXPECT_EQ(byNode.instances[2].mesh, 0);
  document.json["nodes"][1]["weights"] = {1, 2};
  EXPECT_REFUSED(document, "gltf.value", "/nodes/1/weights");
}

/// The triangle on one joint that stands at (5, 0, 0), bound at (1, 0, 0); its own node must not count.
Document makeSkinned(const std::vector<float>& weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                     std::uint8_t joint = 0) {
  Document document = makeTriangle();
  Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      document.addAccessor<std::uint8_t>({joint, 0, 0, 0, joint, 0, 0, 0, joint, 0, 0, 0}, "VEC4", 5121);
  attributes["WEIGHTS_0"] = document.addFloats(weights, "VEC4");
  const int inverse = document.addFloats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, "MAT4");
  document.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 100, 100}}},
                            {{"translation", {5, 0, 0}}}};
  document.json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", inverse}}};
  return document;
}

TEST(GltfMesh, SkinsAreShownInTheirRestPose) {
  const Scene scene = import(makeSkinned());
  EXPECT_EQ(checkScene(scene), "");
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].worldFromMesh, dmat4(1.0));
  EXPECT_EQ(first(scene).positions[0], vec3(4, 0, 0));
  EXPECT_TRUE(scene.motion.isEmpty());  // nothing drives it
  EXPECT_FALSE(first(scene).deformation);
}

TEST(GltfMesh, AMirroringSkinFlipsTheWinding) {
  Document document = makeSkinned();
  document.json["nodes"][1]["scale"] = {1, 1, -1};
  document.json["nodes"][1]["rotation"] = {0, 0, 0, 1};
  const Scene scene = import(document);
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_LT(faceNormal(first(scene), 0).z, 0.0f);
  EXPECT_EQ(first(scene).normals[0], vec3(0, 0, -1));
}

TEST(GltfMesh, SkinWeightsAreNormalisedAndJointsChecked) {
  const Scene scene = import(makeSkinned({2, 0, 0, 0, -1, 0, 0, 0, kNan, 0, 0, 0}));
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_EQ(first(scene).positions[0], vec3(4, 0, 0));
  EXPECT_TRUE(hasWarning(scene, "3 vertices had skin weights"));
  EXPECT_REFUSED(makeSkinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 1), "gltf.index_out_of_range",
                 "/meshes/0/primitives/0/attributes/JOINTS_0");
  Document noJoints = makeTriangle();
  noJoints.json["nodes"][0]["skin"] = 0;
  noJoints.json["skins"] = {{{"joints", {0}}}};
  EXPECT_TRUE(hasWarning(import(noJoints), "has a skin but its mesh has no joints"));
}

TEST(GltfMesh, InverseBindMatricesMustBeAffineFloatsEnough) {
  Document document = makeSkinned();
  document.json["skins"][0]["joints"] = {1, 0};
  EXPECT_REFUSED(document, "gltf.value", "/skins/0/inverseBindMatrices");
  document.json["skins"][0]["joints"] = Json::array();
  EXPECT_REFUSED(document, "gltf.value", "/skins/0/joints");
  Document projective = makeSkinned();
  projective.json["skins"][0]["inverseBindMatrices"] =
      projective.addFloats(std::vector<float>(16, 1.0f), "MAT4");
  EXPECT_EQ(importError(projective)->code(), "gltf.accessor_data");
}

TEST(GltfMesh, UnalignedAttributesAreReadAsTheyStand) {
  Document document = makeTriangle();
  document.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      document.addAccessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255}, "VEC3", 5121);
  document.json["accessors"].back()["normalized"] = true;
  const Scene scene = import(document);
  EXPECT_EQ(first(scene).colors[2], vec4(0, 0, 1, 1));
  EXPECT_TRUE(hasWarning(scene, "not aligned to 4 bytes"));
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
