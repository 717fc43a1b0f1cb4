// SPDX-License-Identifier: Apache-2.0
// Where things stand: the scene that was asked for, world matrices, and what hangs on nodes (meshes, cameras,
// lights). All walks over the nodes use a stack of their own; the depth of the tree costs no call depth.
#pragma once

#include <vector>

#include "catoptric/scene/gltf/data.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene::gltf {

/// The scene's name and root nodes: by ImportOptions::sceneName, else the default scene, else the first, else
/// all roots of the file.
[[nodiscard]] SceneSource chooseScene(Context& context, const Model& model);

/// World matrix of every node of the file (joints may lie outside the scene).
[[nodiscard]] std::vector<dmat4> computeWorldMatrices(const Model& model);

/// Nodes of the scene, parents before children, in document order.
[[nodiscard]] std::vector<int> collectNodes(const Model& model, const SceneSource& scene);

[[nodiscard]] bool isFinite(const dmat4& matrix);

/// Fills Scene::meshes and Scene::instances.
void placeMeshes(const Data& data, const std::vector<int>& nodes, const std::vector<dmat4>& worldFromNode,
                 Scene& scene);

/// Fills Scene::cameras and Scene::lights; needs the instances, to aim the cameras at their depth.
void placeCamerasAndLights(const Data& data, const std::vector<int>& nodes,
                           const std::vector<dmat4>& worldFromNode, Scene& scene);

}  // namespace catoptric::scene::gltf
