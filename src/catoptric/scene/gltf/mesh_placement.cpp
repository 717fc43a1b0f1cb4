// SPDX-License-Identifier: Apache-2.0
// placeMeshes(): one Instance per node with a mesh. A mesh is read once for each way in which it is used:
// morph weights make a mesh of their own, a skin bakes the rest pose into world space (its instance then
// stands at the origin).
#include <fmt/format.h>

#include <map>
#include <tuple>

#include "catoptric/scene/gltf/mesh.h"
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
    if (node.instancing.empty()) {
      addInstance(node, mesh, isSkinned ? dmat4(1.0) : matrix);
      return;
    }
    for (const dmat4& nodeFromCopy : readCopies(node)) addInstance(node, mesh, matrix * nodeFromCopy);
  }

  /// A file of meshes without nodes: each stands at the origin.
  void placeAlone(int meshIndex) {
    Node node;
    node.name = model_.meshes[std::size_t(meshIndex)].name;
    const MeshSource& source = model_.meshes[std::size_t(meshIndex)];
    scene_.meshes.push_back(
        readMesh(data_, meshIndex, source.weights, nullptr, int(model_.materials.size())));
    addInstance(node, int(scene_.meshes.size()) - 1, dmat4(1.0));
  }

 private:
  using Key = std::tuple<int, int, int, std::vector<float>>;  ///< mesh, skin, skinned node, weights

  [[nodiscard]] bool hasJoints(int mesh) const {
    for (const Primitive& primitive : model_.meshes[std::size_t(mesh)].primitives)
      if (findAttribute(primitive.attributes, "JOINTS_0") >= 0) return true;
    return false;
  }

  int findOrReadMesh(int nodeIndex, bool isSkinned) {
    const Node& node = model_.nodes[std::size_t(nodeIndex)];
    const MeshSource& source = model_.meshes[std::size_t(node.mesh)];
    const std::vector<float>& weights = !node.weights.empty() ? node.weights : source.weights;
    if (!source.primitives.front().targets.empty())
      data_.context().warn("morph targets are not animated; the meshes are shown with their default weights");
    const Key key(node.mesh, isSkinned ? node.skin : -1, isSkinned ? nodeIndex : -1, weights);
    const auto [entry, isNew] = meshes_.emplace(key, int(scene_.meshes.size()));
    if (!isNew) return entry->second;
    std::optional<SkinPose> pose;
    if (isSkinned) pose = makePose(nodeIndex);
    scene_.meshes.push_back(
        readMesh(data_, node.mesh, weights, pose ? &*pose : nullptr, int(model_.materials.size())));
    return entry->second;
  }

  SkinPose makePose(int nodeIndex) {
    data_.context().warn("skins are not animated; skinned meshes are shown in their rest pose");
    const Skin& skin = model_.skins[std::size_t(model_.nodes[std::size_t(nodeIndex)].skin)];
    SkinPose pose{.worldFromVertex = {}, .worldFromNode = worldFromNode_[std::size_t(nodeIndex)]};
    std::vector<float> inverse;
    if (skin.inverseBindMatrices >= 0) inverse = data_.readFloats(skin.inverseBindMatrices);
    data_.context().charge(skin.joints.size(), sizeof(dmat4));
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      dmat4 jointFromVertex(1.0);
      for (std::size_t k = 0; k < 16 && !inverse.empty(); ++k)
        jointFromVertex[int(k / 4)][int(k % 4)] = inverse[16 * j + k];
      const bool isAffine = jointFromVertex[0][3] == 0 && jointFromVertex[1][3] == 0 &&
                            jointFromVertex[2][3] == 0 && jointFromVertex[3][3] == 1;
      if (!isAffine || !isFinite(jointFromVertex))
        data_.context().fail("gltf.accessor_data",
                             fmt::format("inverse bind matrix {} is not affine and finite", j),
                             fmt::format("/accessors/{}", skin.inverseBindMatrices));
      pose.worldFromVertex.push_back(worldFromNode_[std::size_t(skin.joints[j])] * jointFromVertex);
    }
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

  void addInstance(const Node& node, int mesh, const dmat4& worldFromMesh) {
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
    scene_.instances.push_back(
        {.name = name, .mesh = mesh, .worldFromMesh = worldFromMesh, .hint = node.hint});
  }

  const Data& data_;
  const Model& model_;
  const std::vector<dmat4>& worldFromNode_;
  Scene& scene_;
  std::map<Key, int> meshes_;
};

bool saysAnything(const ReflectorHint& hint) {
  return hint.reflector || hint.shape || hint.reflectivity || hint.shell;
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
