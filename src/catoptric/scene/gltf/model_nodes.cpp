// SPDX-License-Identifier: Apache-2.0
// Nodes, skins, scenes. The nodes must be trees: nothing here or later follows children by recursion, and a
// cycle or a second parent is refused before any matrix is multiplied.
#include <fmt/format.h>

#include <cmath>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

dmat4 readMatrix(const Element& element) {
  for (const char* key : {"translation", "rotation", "scale"})
    if (element.has(key))
      element.find(key)->fail("gltf.value", "a node has either a matrix or translation, rotation and scale");
  const auto m = element.findNumbers<16>("matrix", {});
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    element.find("matrix")->fail("gltf.value", "the last row of a node's matrix must be 0 0 0 1");
  return glm::make_mat4(m.data());
}

void readTransform(Context& context, const Element& element, Node& node) {
  node.hasMatrix = element.has("matrix");
  if (node.hasMatrix) {
    node.parentFromNode = readMatrix(element);
    return;
  }
  const auto t = element.findNumbers<3>("translation", {0, 0, 0});
  const auto r = element.findNumbers<4>("rotation", {0, 0, 0, 1});
  const auto s = element.findNumbers<3>("scale", {1, 1, 1});
  const glm::dquat rotation(r[3], r[0], r[1], r[2]);
  const double length = glm::length(rotation);
  if (!(length > 1e-6))
    element.find("rotation")->fail("gltf.value", "a rotation must be a unit quaternion, this one is zero");
  if (std::abs(length - 1) > 1e-2) context.count(Repair::Rotation);
  node.translation = dvec3(t[0], t[1], t[2]);
  node.rotation = rotation / length;
  node.scale = dvec3(s[0], s[1], s[2]);
  node.parentFromNode =
      glm::scale(glm::translate(dmat4(1.0), node.translation) * glm::mat4_cast(node.rotation), node.scale);
}

/// EXT_mesh_gpu_instancing: TRANSLATION VEC3, ROTATION VEC4, SCALE VEC3, equally many.
Attributes readInstancing(Context& context, const Element& extension, const Model& model) {
  Attributes out;
  const Element attributes = extension.getObject("attributes");
  std::size_t count = 0;
  for (const char* key : {"ROTATION", "SCALE", "TRANSLATION"}) {
    const int index = attributes.findIndex(key, model.accessors.size(), "accessor");
    if (index < 0) continue;
    const Accessor& accessor = model.accessors[std::size_t(index)];
    const bool isRotation = std::string_view(key) == "ROTATION";
    const bool isFloat = accessor.component == ComponentType::Float;
    const bool isSmall = accessor.normalized && (accessor.component == ComponentType::Int8 ||
                                                 accessor.component == ComponentType::Int16);
    if (accessor.element != (isRotation ? ElementType::Vec4 : ElementType::Vec3) ||
        !(isFloat || (isRotation && isSmall)))
      attributes.find(key)->fail("gltf.accessor_format",
                                 fmt::format("the accessor's type does not suit {}", key));
    if (!out.empty() && accessor.count != count)
      attributes.find(key)->fail("gltf.accessor_format", fmt::format("{} instances have a {}, {} others",
                                                                     accessor.count, key, count));
    count = accessor.count;
    out.emplace_back(key, index);
  }
  if (count > context.options().maxNodes)
    attributes.fail("gltf.nodes", fmt::format("{} instances are more than the limit of {} nodes", count,
                                              context.options().maxNodes));
  return out;
}

void readWeights(const Element& element, const Model& model, Node& node) {
  node.weights = element.findNumberList("weights");
  if (node.weights.empty()) return;
  const Element where = *element.find("weights");
  if (node.mesh < 0) where.fail("gltf.missing", "a node with weights needs a mesh");
  const std::size_t targets = model.meshes[std::size_t(node.mesh)].primitives.front().targets.size();
  if (node.weights.size() != targets)
    where.fail("gltf.value", fmt::format("{} weights for {} morph targets", node.weights.size(), targets));
}

void readNode(Context& context, const Element& element, Model& model, std::size_t nodeCount,
              std::size_t skinCount) {
  Node node;
  node.name = element.findString("name");
  node.children = element.findIndexList("children", nodeCount, "node");
  node.mesh = element.findIndex("mesh", model.meshes.size(), "mesh");
  node.skin = element.findIndex("skin", skinCount, "skin");
  node.camera = element.findIndex("camera", model.cameras.size(), "camera");
  if (const auto light = element.findExtension("KHR_lights_punctual"))
    node.light = light->getIndex("light", model.lights.size(), "light");
  if (node.skin >= 0 && node.mesh < 0)
    element.find("skin")->fail("gltf.missing", "a node with a skin needs a mesh");
  readTransform(context, element, node);
  readWeights(element, model, node);
  if (const auto instancing = element.findExtension("EXT_mesh_gpu_instancing"); instancing && node.mesh >= 0)
    node.instancing = readInstancing(context, *instancing, model);
  node.hint = readReflectorHint(context, element);
  model.nodes.push_back(std::move(node));
}

void linkParents(const Element& list, Model& model) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    for (const int child : model.nodes[i].children) {
      int& parent = model.nodes[std::size_t(child)].parent;
      if (child == int(i))
        list[i].find("children")->fail("gltf.node_cycle", fmt::format("node {} is its own child", i));
      if (parent >= 0)
        list[i]
            .find("children")
            ->fail("gltf.node_parent",
                   fmt::format("node {} is a child of both node {} and node {}", child, parent, i));
      parent = int(i);
    }
}

/// With one parent each, a node that no root reaches hangs on a cycle.
void refuseCycles(const Element& list, const Model& model) {
  std::vector<bool> reached(model.nodes.size(), false);
  std::vector<int> stack(model.roots);
  while (!stack.empty()) {
    const auto node = std::size_t(stack.back());
    stack.pop_back();
    reached[node] = true;
    stack.insert(stack.end(), model.nodes[node].children.begin(), model.nodes[node].children.end());
  }
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (!reached[i])
      list[i].fail("gltf.node_cycle", fmt::format("node {} is its own ancestor or hangs on such a node", i));
}

std::size_t arraySize(const Element& root, const char* key) {
  const std::optional<Element> list = root.findArray(key);
  return list ? list->size() : 0;
}

}  // namespace

void readNodes(Context& context, const Element& root, Model& model) {
  const std::size_t count = arraySize(root, "nodes");
  if (count > context.options().maxNodes)
    root.find("nodes")->fail("gltf.nodes", fmt::format("{} nodes are more than the limit of {}", count,
                                                       context.options().maxNodes));
  context.charge(count, sizeof(Node) + sizeof(dmat4) + sizeof(Instance), "/nodes");
  const std::size_t skinCount = arraySize(root, "skins");
  forEachObject(root, "nodes", [&](const Element& element, std::size_t) {
    readNode(context, element, model, count, skinCount);
  });
  if (count == 0) return;
  const Element list = *root.findArray("nodes");
  linkParents(list, model);
  for (std::size_t i = 0; i < count; ++i)
    if (model.nodes[i].parent < 0) model.roots.push_back(int(i));
  refuseCycles(list, model);
}

void readSkins(Context&, const Element& root, Model& model) {
  forEachObject(root, "skins", [&](const Element& element, std::size_t) {
    Skin skin;
    (void)element.getArray("joints");
    skin.joints = element.findIndexList("joints", model.nodes.size(), "node");
    (void)element.findIndex("skeleton", model.nodes.size(), "node");
    skin.inverseBindMatrices = element.findIndex("inverseBindMatrices", model.accessors.size(), "accessor");
    if (skin.inverseBindMatrices >= 0) {
      const Element where = *element.find("inverseBindMatrices");
      const Accessor& accessor = model.accessors[std::size_t(skin.inverseBindMatrices)];
      if (accessor.element != ElementType::Mat4 || accessor.component != ComponentType::Float)
        where.fail("gltf.accessor_format", "inverse bind matrices must be 4x4 matrices of floats");
      if (accessor.count < skin.joints.size())
        where.fail("gltf.value",
                   fmt::format("{} inverse bind matrices for {} joints", accessor.count, skin.joints.size()));
      if (accessor.bufferView >= 0 && model.bufferViews[std::size_t(accessor.bufferView)].byteStride != 0 &&
          model.bufferViews[std::size_t(accessor.bufferView)].byteStride != 64)
        where.fail("gltf.accessor_stride",
                   "inverse bind matrices must not lie in a buffer view with a stride");
    }
    model.skins.push_back(std::move(skin));
  });
}

void readScenes(Context&, const Element& root, Model& model) {
  forEachObject(root, "scenes", [&](const Element& element, std::size_t) {
    SceneSource scene;
    scene.name = element.findString("name");
    scene.nodes = element.findIndexList("nodes", model.nodes.size(), "node");
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
      if (const int parent = model.nodes[std::size_t(scene.nodes[i])].parent; parent >= 0)
        (*element.find("nodes"))[i].fail(
            "gltf.node_parent",
            fmt::format("node {} is no root, it is a child of node {}", scene.nodes[i], parent));
    model.scenes.push_back(std::move(scene));
  });
  model.defaultScene = root.findIndex("scene", model.scenes.size(), "scene");
}

}  // namespace catoptric::scene::gltf
