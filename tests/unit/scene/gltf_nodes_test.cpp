// SPDX-License-Identifier: Apache-2.0
// Node trees, transforms, scenes, cameras, lights, instancing, extras.catoptric of nodes.
#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

void expectNear(const dvec3& a, const dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-9) << a.x << " " << a.y << " " << a.z;
}

dvec3 originOf(const Instance& instance) {
  return dvec3(instance.worldFromMesh[3]);
}

Document withNodes(const Json& nodes) {
  Document document = makeTriangle();
  document.json["nodes"] = nodes;
  return document;
}

TEST(GltfNodes, ChildrenInheritTheirParentsTransform) {
  const Scene scene = import(withNodes(
      {{{"translation", {1, 0, 0}}, {"children", {1}}},
       {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"scale", {2, 2, 2}}, {"children", {2}}},
       {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1}}, {"mesh", 0}, {"name", "leaf"}}}));
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "leaf");
  expectNear(originOf(scene.instances[0]), dvec3(1, 6, 0));
}

TEST(GltfNodes, NegativeScalesStayInTheMatrix) {
  const Scene scene = import(withNodes({{{"mesh", 0}, {"scale", {-1, 1, 1}}}}));
  EXPECT_LT(glm::determinant(scene.instances[0].worldFromMesh), 0.0);
}

TEST(GltfNodes, ADeepChainCostsNoStack) {
  Json nodes = Json::array();
  constexpr int kDepth = 200000;
  for (int i = 0; i + 1 < kDepth; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  const Scene scene = import(withNodes(nodes));
  ASSERT_EQ(scene.instances.size(), 1u);
  expectNear(originOf(scene.instances[0]), dvec3(kDepth - 1, 0, 0));
}

TEST(GltfNodes, TreesOnly) {
  EXPECT_REFUSED(withNodes({{{"children", {0}}}}), "gltf.node_cycle", "/nodes/0/children");
  EXPECT_REFUSED(withNodes({Json::object(), {{"children", {2}}}, {{"children", {1}}}}), "gltf.node_cycle",
                 "/nodes/1");
  EXPECT_REFUSED(withNodes({{{"children", {2}}}, {{"children", {2}}}, Json::object()}), "gltf.node_parent",
                 "/nodes/1/children");
  EXPECT_REFUSED(withNodes({{{"children", {1, 1}}}, Json::object()}), "gltf.duplicate",
                 "/nodes/0/children/1");
  EXPECT_REFUSED(withNodes({{{"children", {1}}}}), "gltf.index_out_of_range", "/nodes/0/children/0");
  Document child = withNodes({{{"children", {1}}}, Json::object()});
  child.json["scenes"] = {{{"nodes", {1}}}};
  EXPECT_REFUSED(child, "gltf.node_parent", "/scenes/0/nodes/0");
  child.json["scenes"] = {{{"nodes", {0, 0}}}};
  EXPECT_REFUSED(child, "gltf.duplicate", "/scenes/0/nodes/1");
}

TEST(GltfNodes, Transforms) {
  const Json identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_REFUSED(withNodes({{{"matrix", identity}, {"translation", {0, 0, 0}}}}), "gltf.value",
                 "/nodes/0/translation");
  EXPECT_REFUSED(withNodes({{{"matrix", {1, 2, 3}}}}), "gltf.value", "/nodes/0/matrix");
  EXPECT_REFUSED(withNodes({{{"matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}), "gltf.value",
                 "/nodes/0/matrix");
  EXPECT_REFUSED(withNodes({{{"rotation", {0, 0, 0, 0}}}}), "gltf.value", "/nodes/0/rotation");
  EXPECT_REFUSED(withNodes({{{"scale", {1, 1}}}}), "gltf.value", "/nodes/0/scale");
  EXPECT_REFUSED(withNodes({{{"scale", {1, 1, 1e300}}}}), "gltf.value", "/nodes/0/scale/2");
  const Scene scene = import(withNodes({{{"mesh", 0}, {"rotation", {0, 0, 2, 0}}}}));
  EXPECT_TRUE(hasWarning(scene, "1 node rotations"));
  EXPECT_NEAR(glm::determinant(scene.instances[0].worldFromMesh), 1.0, 1e-12);
}

TEST(GltfNodes, TransformsThatOverflowDropTheirInstance) {
  Json nodes = Json::array();
  for (int i = 0; i < 20; ++i) nodes.push_back({{"scale", {1e30, 1e30, 1e30}}, {"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}, {"camera", 0}});
  Document document = withNodes(nodes);
  document.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  const Scene scene = import(document);
  EXPECT_EQ(checkScene(scene), "");
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_TRUE(hasWarning(scene, "beyond all numbers"));
}

TEST(GltfNodes, WarningsAreNotEndless) {
  Json nodes = Json::array();
  for (int i = 0; i < 1000; ++i)
    nodes.push_back({{"name", "n" + std::to_string(i)}, {"extras", {{"catoptric", {{"shell", true}}}}}});
  const Scene scene = import(withNodes(nodes));
  EXPECT_LT(scene.warnings.size(), 110u);
  EXPECT_TRUE(hasWarning(scene, "further warnings"));
}

TEST(GltfNodes, MeshesAreShared) {
  const Scene scene = import(withNodes({{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}}));
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 3u);
}

TEST(GltfNodes, MeshesWithoutNodesStandAtTheOrigin) {
  Document document = makeTriangle();
  document.json.erase("nodes");
  const Scene scene = import(document);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(hasWarning(scene, "no nodes"));
}

TEST(GltfScenes, ByNameIndexOrDefault) {
  Document document = withNodes({{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}});
  document.json["scenes"] = {{{"name", "day"}, {"nodes", {0}}},
                             {{"name", "night"}, {"nodes", {1}}},
                             {{"name", "0"}, {"nodes", {0, 1}}}};
  const auto namesIn = [&](std::optional<std::string> scene) {
    ImportOptions options;
    options.sceneName = std::move(scene);
    std::string names;
    for (const Instance& instance : import(document, options).instances) names += instance.name;
    return names;
  };
  EXPECT_EQ(namesIn(std::nullopt), "a");
  document.json["scene"] = 1;
  EXPECT_EQ(namesIn(std::nullopt), "b");
  EXPECT_EQ(namesIn("day"), "a");
  EXPECT_EQ(namesIn("1"), "b");
  EXPECT_EQ(namesIn("0"), "ab") << "a name goes before an index";
  ImportOptions options;
  options.sceneName = "dusk";
  const auto error = importError(document, options);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), "gltf.scene");
  EXPECT_NE(error->hint().find("\"night\""), std::string::npos);
  document.json["scene"] = 3;
  EXPECT_REFUSED(document, "gltf.index_out_of_range", "/scene");
}

Document withCamera(const Json& camera) {
  Document document =
      withNodes({{{"mesh", 0}},
                 {{"camera", 0}, {"translation", {0, 0, 10}}, {"rotation", {0, 0, 0, 1}}, {"name", "eye"}}});
  document.json["cameras"] = {camera};
  return document;
}

TEST(GltfCameras, PerspectiveLooksAlongMinusZ) {
  const Scene scene = import(
      withCamera({{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"zfar", 100}}}}));
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  EXPECT_DOUBLE_EQ(camera.fovYRadians, 0.5);
  expectNear(camera.eye, dvec3(0, 0, 10));
  expectNear(camera.target, dvec3(0, 0, 0));
  expectNear(camera.up, dvec3(0, 1, 0));
}

TEST(GltfCameras, OrthographicIsADistantPerspective) {
  const Scene scene = import(withCamera(
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 100}}}}));
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_NEAR(std::tan(camera.fovYRadians / 2) * glm::length(camera.eye - camera.target), 3.0, 1e-9);
  expectNear(camera.target, dvec3(0, 0, 0));
  EXPECT_TRUE(hasWarning(scene, "orthographic"));
}

TEST(GltfCameras, Rules) {
  const auto perspective = [](const Json& body) {
    return withCamera({{"type", "perspective"}, {"perspective", body}});
  };
  const auto orthographic = [](const Json& body) {
    return withCamera({{"type", "orthographic"}, {"orthographic", body}});
  };
  EXPECT_REFUSED(perspective({{"znear", 1}}), "gltf.missing", "/cameras/0/perspective");
  EXPECT_REFUSED(perspective({{"yfov", 0}, {"znear", 1}}), "gltf.value", "/cameras/0/perspective/yfov");
  EXPECT_REFUSED(perspective({{"yfov", 4}, {"znear", 1}}), "gltf.value", "/cameras/0/perspective/yfov");
  EXPECT_REFUSED(perspective({{"yfov", 1}, {"znear", 1}, {"zfar", 1}}), "gltf.value",
                 "/cameras/0/perspective");
  EXPECT_REFUSED(orthographic({{"xmag", 0}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}), "gltf.value",
                 "/cameras/0/orthographic");
  EXPECT_REFUSED(orthographic({{"xmag", 1}, {"ymag", 1}, {"znear", 2}, {"zfar", 1}}), "gltf.value",
                 "/cameras/0/orthographic");
  EXPECT_REFUSED(withCamera({{"type", "fisheye"}}), "gltf.value", "/cameras/0/type");
  EXPECT_REFUSED(withCamera({{"type", "perspective"}}), "gltf.missing", "/cameras/0");
}

Document withLight(const Json& light) {
  Document document = withNodes({{{"mesh", 0}},
                                 {{"translation", {1, 2, 3}},
                                  {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
  document.json["extensionsUsed"] = {"KHR_lights_punctual"};
  document.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {light}}}}};
  return document;
}

TEST(GltfLights, SpotWithAllItsMembers) {
  const Scene scene = import(withLight({{"type", "spot"},
                                        {"color", {1, 0.5, 0}},
                                        {"intensity", 4},
                                        {"range", 7},
                                        {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}));
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& light = scene.lights[0];
  EXPECT_EQ(light.type, LightType::Spot);
  EXPECT_EQ(light.color, vec3(4, 2, 0));
  EXPECT_EQ(light.position, vec3(1, 2, 3));
  expectNear(dvec3(light.direction), dvec3(0, -1, 0));
  EXPECT_FLOAT_EQ(light.range, 7.0f);
  EXPECT_FLOAT_EQ(light.innerConeRadians, 0.1f);
  EXPECT_FLOAT_EQ(light.outerConeRadians, 0.2f);
}

TEST(GltfLights, Rules) {
  EXPECT_REFUSED(withLight({{"type", "area"}}), "gltf.value",
                 "/extensions/KHR_lights_punctual/lights/0/type");
  EXPECT_REFUSED(withLight({{"type", "spot"}}), "gltf.missing", "/extensions/KHR_lights_punctual/lights/0");
  EXPECT_REFUSED(withLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}),
                 "gltf.value", "/extensions/KHR_lights_punctual/lights/0/spot");
  EXPECT_REFUSED(withLight({{"type", "point"}, {"intensity", -1}}), "gltf.value",
                 "/extensions/KHR_lights_punctual/lights/0/intensity");
  Document document = withLight({{"type", "point"}});
  document.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 1;
  EXPECT_REFUSED(document, "gltf.index_out_of_range", "/nodes/1/extensions/KHR_lights_punctual/light");
}

TEST(GltfNodes, GpuInstancing) {
  Document document = makeTriangle();
  const int translation = document.addFloats({1, 0, 0, 2, 0, 0}, "VEC3"),
            scale = document.addFloats({1, 1, 1, 3, 3, 3}, "VEC3");
  const int rotation = document.addAccessor<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", 5120);
  document.json["accessors"].back()["normalized"] = true;
  document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  document.json["nodes"][0]["translation"] = {0, 5, 0};
  document.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translation}, {"SCALE", scale}, {"ROTATION", rotation}};
  const Scene scene = import(document);
  ASSERT_EQ(scene.instances.size(), 2u);
  expectNear(originOf(scene.instances[1]), dvec3(2, 5, 0));
  expectNear(dvec3(scene.instances[1].worldFromMesh[0]), dvec3(-3, 0, 0));
  document.json["accessors"][std::size_t(scale)]["count"] = 1;
  EXPECT_REFUSED(document, "gltf.accessor_format",
                 "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE");
}

TEST(GltfHints, OfNodes) {
  const auto withHint = [](const Json& hint) {
    return withNodes({{{"mesh", 0}, {"extras", {{"catoptric", hint}, {"other", 1}}}}});
  };
  const Scene scene =
      import(withHint({{"reflector", true}, {"shape", "sphere"}, {"reflectivity", 0.25}, {"shell", false}}));
  const ReflectorHint& hint = scene.instances.at(0).hint;
  EXPECT_EQ(hint.reflector, true);
  EXPECT_EQ(hint.shape, "sphere");
  EXPECT_EQ(hint.reflectivity, 0.25f);
  EXPECT_EQ(hint.shell, false);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_FALSE(import(withHint(Json::object())).instances.at(0).hint.reflector.has_value());
  EXPECT_TRUE(hasWarning(import(withHint({{"reflektor", true}})), "reflektor"));
  EXPECT_REFUSED(withHint({{"reflector", 1}}), "gltf.type", "/nodes/0/extras/catoptric/reflector");
  EXPECT_REFUSED(withHint({{"shape", "torus"}}), "gltf.value", "/nodes/0/extras/catoptric/shape");
  EXPECT_REFUSED(withHint({{"reflectivity", 1.5}}), "gltf.value", "/nodes/0/extras/catoptric/reflectivity");
  EXPECT_REFUSED(withHint(3), "gltf.type", "/nodes/0/extras/catoptric");
  EXPECT_EQ(import(withNodes({{{"mesh", 0}, {"extras", "text"}}})).instances.size(), 1u);
  EXPECT_TRUE(hasWarning(import(withNodes({{{"extras", {{"catoptric", {{"shell", true}}}}}}})), "no mesh"));
}

TEST(GltfAnimations, AreReadAndChecked) {
  const auto animated = [](const Json& change) {
    Document document = makeTriangle();
    const int times = document.addFloats({0, 1}, "SCALAR"),
              values = document.addFloats({0, 0, 0, 1, 1, 1}, "VEC3");
    document.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", values}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    document.json.merge_patch(change);
    return document;
  };
  EXPECT_EQ(import(animated(Json::object())).motion.animations.size(), 1u);
  Document wrongCount = animated(Json::object());
  wrongCount.json["accessors"][3]["count"] = 1;
  EXPECT_REFUSED(wrongCount, "gltf.value", "/animations/0/channels/0/sampler");
  Document twice = animated(Json::object());
  twice.json["animations"][0]["channels"].push_back(twice.json["animations"][0]["channels"][0]);
  EXPECT_REFUSED(twice, "gltf.duplicate", "/animations/0/channels/1/target");
  Document scaled = animated(Json::object());
  scaled.json["animations"][0]["channels"][0]["target"]["path"] = "rotation";
  EXPECT_REFUSED(scaled, "gltf.accessor_format", "/animations/0/channels/0/sampler");
  Document missing = animated(Json::object());
  missing.json["animations"][0]["channels"][0]["sampler"] = 1;
  EXPECT_REFUSED(missing, "gltf.index_out_of_range", "/animations/0/channels/0/sampler");
}

}  // namespace
}  // namespace catoptric::scene::gltf_test
