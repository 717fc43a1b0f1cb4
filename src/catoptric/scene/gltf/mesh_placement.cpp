// SPDX-License-Identifier: Apache-2.0
// placeMeshes(): one Instance per node with a mesh. A mesh is read once for each way in which it is used:
// morph weights make a mesh of their own, a skin bakes the rest pose into world space (its instance then
// stands at the origin).
#include <fmt/format.h>

#include <map>
#include <tuple>

#include "catoptric/scene/gltf/mesh.h"
#include "catoptric/scene/gltf/motion.h"
#include "catoptric/scene/gltf/placement.h"

namespace catoptric::scene::gltf {
namespace {

/// What flattening to world space will need for one vertex and one triangle of an instance.
constexpr std::size_t kWorldBytesPerVertex = 72, kWorldBytesPerTriangle = 16;

class MeshPlacer {
 public:
  MeshPlacer(const Data& data, const std::vector<dmat4>& worldFromNode, Scene& scene)
      : data_(data), model_(data.model()), worldFromNode_(worldFromNode), scene_(scene) {}

  void place(int nodeIndex) {
    const Node& node = model_.nodes[std::size_t(nodeIndex)];
    const dmat4& matrix = worldFromNode_[std::size_t(nodeIndex)];
    if (!isFinite(matrix)) {
      data_.context().warn(fmt::format("node \"{}\" places its mesh beyond all numbers and was left out",
                                       printable(node.name)));
      return;
    }
    const bool isSkinned = node.skin >= 0 && hasJoints(node.mesh);
    if (node.skin >= 0 && !isSkinned)
      data_.context().warn(fmt::format(
          "node \"{}\" has a skin but its mesh has no joints; the skin was ignored", printable(node.name)));
    const int mesh = findOrReadMesh(nodeIndex, isSkinned);
    const Carrier carrier{.node = model_.animations.empty() || isSkinned ? -1 : nodeIndex};
    if (node.instancing.empty()) {
      addInstance(node, mesh, isSkinned ? dmat4(1.0) : matrix, carrier);
      return;
    }
    for (const dmat4& nodeFromCopy : readCopies(node))
      addInstance(node, mesh, matrix * nodeFromCopy, {carrier.node, nodeFromCopy});
  }

  /// A file of meshes without nodes: each stands at the origin.
  void placeAlone(int meshIndex) {
    Node node;
    node.name = model_.meshes[std::size_t(meshIndex)].name;
    const MeshSource& source = model_.meshes[std::size_t(meshIndex)];
    scene_.meshes.push_back(
        readMesh(data_, meshIndex, source.weights, nullptr, int(model_.materials.size()), false));
    addInstance(node, int(scene_.meshes.size()) - 1, dmat4(1.0), {});
  }

 private:
  /// Mesh, skin, node that skins it or drives its weights, weights.
  using Key = std::tuple<int, int, int, std::vector<float>>;
  /// What moves an instance: worldFromMesh = worldFromNode nodeFromMesh; -1 = nothing.
  struct Carrier {
    int node = -1;
    dmat4 nodeFromMesh{1.0};
  };

  [[nodiscard]] bool hasDrivenWeights(int node) const {
    for (const AnimationSource& animation : model_.animations)
      for (const ChannelSource& channel : animation.channels)
        if (channel.node == node && channel.property == AnimatedProperty::Weights) return true;
    return false;
  }

  [[nodiscard]] bool hasJoints(int mesh) const {
    for (const Primitive& primitive : model_.meshes[std::size_t(mesh)].primitives)
      if (findAttribute(primitive.attributes, "JOINTS_0") >= 0) return true;
    return false;
  }

  int findOrReadMesh(int nodeIndex, bool isSkinned) {
    const Node& node = model_.nodes[std::size_t(nodeIndex)];
    const MeshSource& source = model_.meshes[std::size_t(node.mesh)];
    const std::vector<float>& weights = !node.weights.empty() ? node.weights : source.weights;
    const bool isDriven = hasDrivenWeights(nodeIndex),
               isDeformed = isDriven || (isSkinned && !model_.animations.empty());
    const Key key(node.mesh, isSkinned ? node.skin : -1, isSkinned || isDriven ? nodeIndex : -1, weights);
    const auto [entry, isNew] = meshes_.emplace(key, int(scene_.meshes.size()));
    if (!isNew) return entry->second;
    std::optional<SkinPose> pose;
    if (isSkinned) pose = makePose(nodeIndex);
    scene_.meshes.push_back(readMesh(data_, node.mesh, weights, pose ? &*pose : nullptr,
                                     int(model_.materials.size()), isDeformed));
    if (isDeformed) {
      scene_.meshes.back().node = nodeIndex;
      scene_.meshes.back().skin = isSkinned ? node.skin : -1;
    }
    return entry->second;
  }

  SkinPose makePose(int nodeIndex) {
    const Skin& skin = model_.skins[std::size_t(model_.nodes[std::size_t(nodeIndex)].skin)];
    SkinPose pose{.worldFromVertex = {}, .worldFromNode = worldFromNode_[std::size_t(nodeIndex)]};
    const std::vector<dmat4> jointFromVertex = readInverseBindMatrices(data_, skin);
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
      pose.worldFromVertex.push_back(worldFromNode_[std::size_t(skin.joints[j])] * jointFromVertex[j]);
    return pose;
  }

  /// EXT_mesh_gpu_instancing: a matrix for each copy.
  std::vector<dmat4> readCopies(const Node& node) {
    const auto read = [&](const char* name) {
      const int accessor = findAttribute(node.instancing, name);
      return accessor >= 0 ? data_.readFloats(accessor) : std::vector<float>();
    };
    const std::vector<float> t = read("TRANSLATION"), r = read("ROTATION"), s = read("SCALE");
    const std::size_t count = model_.accessors[std::size_t(node.instancing.front().second)].count;
    data_.context().charge(count, sizeof(dmat4));
    std::vector<dmat4> copies;
    for (std::size_t i = 0; i < count; ++i) {
      dmat4 matrix(1.0);
      if (!t.empty()) matrix = glm::translate(matrix, dvec3(t[3 * i], t[3 * i + 1], t[3 * i + 2]));
      if (!r.empty())
        matrix *=
            glm::mat4_cast(glm::normalize(glm::dquat(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2])));
      if (!s.empty()) matrix = glm::scale(matrix, dvec3(s[3 * i], s[3 * i + 1], s[3 * i + 2]));
      copies.push_back(matrix);
    }
    return copies;
  }

  void addInstance(const Node& node, int mesh, const dmat4& worldFromMesh, const Carrier& carrier) {
    if (scene_.meshes[std::size_t(mesh)].primitives.empty()) return;
    if (!isFinite(worldFromMesh)) {
      data_.context().warn(fmt::format("node \"{}\" places its mesh beyond all numbers and was left out",
                                       printable(node.name)));
      return;
    }
    data_.context().charge(1, sizeof(Instance));
    for (const MeshPrimitive& primitive : scene_.meshes[std::size_t(mesh)].primitives) {
      data_.context().charge(primitive.positions.size(), kWorldBytesPerVertex);
      data_.context().charge(primitive.indices.size() / 3, kWorldBytesPerTriangle);
    }
    const std::string& name = !node.name.empty() ? node.name : scene_.meshes[std::size_t(mesh)].name;
    scene_.instances.push_back({.name = name,
                                .mesh = mesh,
                                .worldFromMesh = worldFromMesh,
                                .hint = node.hint,
                                .node = carrier.node,
                                .nodeFromMesh = carrier.nodeFromMesh});
  }

  const Data& data_;
  const Model& model_;
  const std::vector<dmat4>& worldFromNode_;
  Scene& scene_;
  std::map<Key, int> meshes_;
};

bool saysAnything(const ReflectorHint& hint) {
  return hint.reflector || hint.shape || hint.reflectivity || hint.morphed || hint.shell;
}

}  // namespace

void placeMeshes(const Data& data, const std::vector<int>& nodes, const std::vector<dmat4>& worldFromNode,
                 Scene& scene) {
  const Model& model = data.model();
  MeshPlacer placer(data, worldFromNode, scene);
  for (const int i : nodes) {
    const Node& node = model.nodes[std::size_t(i)];
    if (node.mesh >= 0)
      placer.place(i);
    else if (saysAnything(node.hint))
      data.context().warn(
          fmt::format("node \"{}\" has extras.catoptric but no mesh; it was ignored", printable(node.name)));
  }
  if (!model.nodes.empty() || model.meshes.empty()) return;
  data.context().warn("the file has meshes but no nodes; each mesh was placed at the origin");
  for (std::size_t i = 0; i < model.meshes.size(); ++i) placer.placeAlone(int(i));
}

}  // namespace catoptric::scene::gltf
