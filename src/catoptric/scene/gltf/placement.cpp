// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace catoptric::scene::gltf {
namespace {

/// "2" -> 2; nullopt if the text is no plain number.
std::optional<std::size_t> parseIndex(const std::string& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void failNoSuchScene(Context& context, const Model& model, const std::string& wanted) {
  std::string known;
  for (std::size_t i = 0; i < model.scenes.size() && i < 8; ++i)
    known += fmt::format("{}{} \"{}\"", i > 0 ? ", " : "", i, printable(model.scenes[i].name));
  context.fail("gltf.scene", fmt::format("there is no scene \"{}\"", printable(wanted)), "/scenes",
               known.empty() ? "the file has no scenes" : "the file has " + known);
}

core::Box computeBounds(const Scene& scene) {
  std::vector<core::Box> meshBoxes(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    for (const MeshPrimitive& primitive : scene.meshes[i].primitives)
      for (const vec3& p : primitive.positions) meshBoxes[i].add(dvec3(p));
  core::Box bounds;
  for (const Instance& instance : scene.instances) {
    const core::Box& box = meshBoxes[std::size_t(instance.mesh)];
    for (int corner = 0; corner < 8 && !box.isEmpty(); ++corner) {
      const dvec3 p(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                    corner & 4 ? box.upper.z : box.lower.z);
      bounds.add(dvec3(instance.worldFromMesh * dvec4(p, 1.0)));
    }
  }
  return bounds;
}

std::optional<dvec3> unit(const dvec3& v) {
  const double length = glm::length(v);
  if (!(length > 1e-150 && std::isfinite(length))) return std::nullopt;
  return v / length;
}

/// An orthographic camera as a perspective one of 2 degrees, so far away that it shows the same height at the
/// depth of the scene's centre.
void makeDistant(Camera& camera, const dvec3& forward, double halfHeight) {
  constexpr double kFovY = 2.0 * glm::pi<double>() / 180.0;
  camera.fovYRadians = kFovY;
  camera.eye = camera.target - forward * (halfHeight / std::tan(0.5 * kFovY));
}

void placeCamera(Context& context, const CameraSource& source, const Node& node, const dmat4& matrix,
                 const core::Box& bounds, int motionNode, Scene& scene) {
  const std::optional<dvec3> forward = unit(-dvec3(matrix[2])), upward = unit(dvec3(matrix[1]));
  if (!isFinite(matrix) || !forward || !upward || !unit(glm::cross(*forward, *upward))) {
    context.warn(fmt::format("the camera of node \"{}\" has no usable direction and was left out",
                             printable(node.name)));
    return;
  }
  Camera camera;
  camera.name = !source.name.empty() ? source.name : node.name;
  camera.eye = dvec3(matrix[3]);
  camera.up = *upward;
  // The target only matters to those who orbit: at the depth of the scene's centre, if that is ahead.
  const double depth = bounds.isEmpty() ? 1.0 : glm::dot(bounds.centre() - camera.eye, *forward);
  const double targetDistance = depth > 0 && std::isfinite(depth) ? depth : 1.0;
  camera.target = camera.eye + targetDistance * *forward;
  camera.fovYRadians = source.fovYRadians;
  camera.node = motionNode;
  if (source.orthographic) {
    context.warn(fmt::format("the orthographic camera \"{}\" is shown as a distant perspective camera",
                             printable(camera.name)));
    makeDistant(camera, *forward, source.halfHeight * glm::length(dvec3(matrix[1])));
  }
  scene.cameras.push_back(std::move(camera));
}

void placeLight(Context& context, const LightSource& source, const Node& node, const dmat4& matrix,
                int motionNode, Scene& scene) {
  const std::optional<dvec3> direction = unit(-dvec3(matrix[2]));
  if (!isFinite(matrix) || (!direction && source.type != "point")) {
    context.warn(fmt::format("the light of node \"{}\" has no usable direction and was left out",
                             printable(node.name)));
    return;
  }
  Light light;
  light.type = source.type == "directional" ? LightType::Directional
               : source.type == "spot"      ? LightType::Spot
                                            : LightType::Point;
  light.color = source.color;
  light.node = motionNode;
  light.position = vec3(dvec3(matrix[3]));
  if (direction) light.direction = vec3(*direction);
  light.range = source.range;
  light.innerConeRadians = source.innerConeRadians;
  if (source.type == "spot") light.outerConeRadians = source.outerConeRadians;
  scene.lights.push_back(light);
}

}  // namespace

bool isFinite(const dmat4& matrix) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(matrix[column][row]) < 1e30)) return false;
  return true;
}

SceneSource chooseScene(Context& context, const Model& model) {
  if (const std::optional<std::string>& wanted = context.options().sceneName) {
    for (const SceneSource& scene : model.scenes)
      if (scene.name == *wanted) return scene;
    const std::optional<std::size_t> index = parseIndex(*wanted);
    if (!index || *index >= model.scenes.size()) failNoSuchScene(context, model, *wanted);
    return model.scenes[*index];
  }
  if (model.defaultScene >= 0) return model.scenes[std::size_t(model.defaultScene)];
  if (!model.scenes.empty()) return model.scenes[0];
  return {.name = {}, .nodes = model.roots};
}

std::vector<dmat4> computeWorldMatrices(const Model& model) {
  std::vector<dmat4> worldFromNode(model.nodes.size(), dmat4(1.0));
  for (const int i : collectNodes(model, {.name = {}, .nodes = model.roots})) {
    const Node& node = model.nodes[std::size_t(i)];
    worldFromNode[std::size_t(i)] =
        node.parent < 0 ? node.parentFromNode : worldFromNode[std::size_t(node.parent)] * node.parentFromNode;
  }
  return worldFromNode;
}

std::vector<int> collectNodes(const Model& model, const SceneSource& scene) {
  std::vector<int> out, stack(scene.nodes.rbegin(), scene.nodes.rend());
  while (!stack.empty()) {
    out.push_back(stack.back());
    const std::vector<int>& children = model.nodes[std::size_t(stack.back())].children;
    stack.pop_back();
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return out;
}

void placeCamerasAndLights(const Data& data, const std::vector<int>& nodes,
                           const std::vector<dmat4>& worldFromNode, Scene& scene) {
  const Model& model = data.model();
  const bool hasCamera =
      std::any_of(nodes.begin(), nodes.end(), [&](int i) { return model.nodes[std::size_t(i)].camera >= 0; });
  const core::Box bounds = hasCamera ? computeBounds(scene) : core::Box();
  for (const int i : nodes) {
    const Node& node = model.nodes[std::size_t(i)];
    const dmat4& matrix = worldFromNode[std::size_t(i)];
    const int motionNode = model.animations.empty() ? -1 : i;
    if (node.camera >= 0)
      placeCamera(data.context(), model.cameras[std::size_t(node.camera)], node, matrix, bounds, motionNode,
                  scene);
    if (node.light >= 0)
      placeLight(data.context(), model.lights[std::size_t(node.light)], node, matrix, motionNode, scene);
  }
}

}  // namespace catoptric::scene::gltf
