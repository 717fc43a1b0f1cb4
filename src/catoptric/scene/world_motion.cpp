// SPDX-License-Identifier: Apache-2.0
// Steps of setTime(): 1 the pose; 2 instances, cameras, lights; 3 meshes; 4 vertices of the moving parts; 5
// what is measured on them: bounds, reflectors.
#include "catoptric/scene/world_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "catoptric/core/parallel.h"

namespace catoptric::scene {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr float kLargestCoordinate = 1e15f;

bool isUsable(const vec3& p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;  // false for NaN
}

bool isMirroring(const dmat4& m) {
  return glm::determinant(dmat3(m)) < 0;
}

/// Direction in the world; `fallback` where the matrix leaves nothing of it.
dvec3 moveDirection(const dmat4& m, const dvec3& direction, const dvec3& fallback) {
  const dvec3 moved = dmat3(m) * direction;
  const double length = glm::length(moved);
  return length > 1e-150 && std::isfinite(length) ? moved / length : fallback;
}

}  // namespace

WorldMotion::WorldMotion(Scene& scene, WorldGeometry& world, const ReflectorOptions& options,
                         const std::string& animation)
    : scene_(scene), world_(world), options_(options), choice_(chooseAnimations(scene.motion, animation)) {
  findMovingNodes();
  computePose(scene_.motion, {}, 0.0, pose_);
  meshDeforms_.resize(scene.meshes.size());
  deformed_.resize(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    meshDeforms_[i] = isDeformed(scene.meshes[i]);
    deformed_[i].resize(scene.meshes[i].primitives.size());
  }
  wasMirroring_.resize(scene.instances.size());
  shifts_.resize(scene.instances.size(), dvec3(0));
  for (const Instance& instance : scene.instances) placements_.push_back(instance.worldFromMesh);
  for (std::uint32_t i = 0; i < world.parts.size(); ++i) {
    const Instance& instance = scene.instances[world.parts[i].object];
    if (moves(instance.node) || meshDeforms_[std::size_t(instance.mesh)]) movingParts_.push_back(i);
  }
  const auto nodeFromWorld = [&](int node) {
    return node >= 0 ? glm::inverse(pose_.worldFromNode[std::size_t(node)]) : dmat4(1.0);
  };
  for (const Camera& camera : scene.cameras) restCameras_.push_back({camera, nodeFromWorld(camera.node)});
  for (const Light& light : scene.lights) restLights_.push_back({light, nodeFromWorld(light.node)});
}

void WorldMotion::findMovingNodes() {
  nodeMoves_.resize(scene_.motion.nodes.size(), false);
  for (const AnimationChannel* channel : choice_.channels)
    if (channel->property != AnimatedProperty::Weights) nodeMoves_[std::size_t(channel->node)] = true;
  for (const int i : scene_.motion.order)
    if (moves(scene_.motion.nodes[std::size_t(i)].parent)) nodeMoves_[std::size_t(i)] = true;
}

bool WorldMotion::isDeformed(const Mesh& mesh) const {
  for (const AnimationChannel* channel : choice_.channels)
    if (channel->property == AnimatedProperty::Weights && channel->node == mesh.node) return true;
  if (mesh.skin < 0) return false;
  for (const int joint : scene_.motion.skins[std::size_t(mesh.skin)].joints)
    if (moves(joint)) return true;
  return moves(mesh.node);  // its primitives without joints
}

void WorldMotion::placeInstances() {
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    Instance& instance = scene_.instances[i];
    if (!moves(instance.node)) continue;
    placements_[i] = pose_.worldFromNode[std::size_t(instance.node)] * instance.nodeFromMesh;
    instance.worldFromMesh = glm::translate(dmat4(1.0), shifts_[i]) * placements_[i];
  }
}

void WorldMotion::placeCamerasAndLights() {
  for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
    const auto& [rest, nodeFromWorld] = restCameras_[i];
    if (!moves(rest.node)) continue;
    const dmat4 moved = pose_.worldFromNode[std::size_t(rest.node)] * nodeFromWorld;
    const double distance = glm::length(rest.target - rest.eye);
    Camera& camera = scene_.cameras[i];
    camera.eye = dvec3(moved * dvec4(rest.eye, 1.0));
    camera.target =
        camera.eye + distance * moveDirection(moved, (rest.target - rest.eye) / distance, dvec3(0, 0, -1));
    camera.up = moveDirection(moved, rest.up, rest.up);
  }
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    const auto& [rest, nodeFromWorld] = restLights_[i];
    if (!moves(rest.node)) continue;
    const dmat4 moved = pose_.worldFromNode[std::size_t(rest.node)] * nodeFromWorld;
    scene_.lights[i].position = vec3(dvec3(moved * dvec4(dvec3(rest.position), 1.0)));
    scene_.lights[i].direction = vec3(moveDirection(moved, dvec3(rest.direction), dvec3(rest.direction)));
  }
}

void WorldMotion::deformMeshes() {
  for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
    if (!meshDeforms_[i]) continue;
    const Mesh& mesh = scene_.meshes[i];
    worldFromVertex_.clear();
    if (mesh.skin >= 0) {
      const SkinBinding& skin = scene_.motion.skins[std::size_t(mesh.skin)];
      for (std::size_t j = 0; j < skin.joints.size(); ++j)
        worldFromVertex_.push_back(pose_.worldFromNode[std::size_t(skin.joints[j])] *
                                   skin.jointFromVertex[j]);
    }
    const std::span<const float> weights = mesh.node >= 0
                                               ? std::span<const float>(pose_.weights[std::size_t(mesh.node)])
                                               : std::span<const float>();
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
      if (mesh.primitives[p].deformation)
        deform(*mesh.primitives[p].deformation, weights, worldFromVertex_, deformed_[i][p]);
  }
}

void WorldMotion::writePart(const Part& part) {
  const Instance& instance = scene_.instances[part.object];
  const auto meshIndex = std::size_t(instance.mesh);
  const MeshPrimitive& primitive = scene_.meshes[meshIndex].primitives[part.primitive];
  const bool isDeformed = isPosed_ && meshDeforms_[meshIndex] && primitive.deformation;
  const DeformedVertices& deformed = deformed_[meshIndex][part.primitive];
  const std::vector<vec3>& positions = isDeformed ? deformed.positions : primitive.positions;
  const std::vector<vec3>& normals = isDeformed ? deformed.normals : primitive.normals;
  const std::vector<vec4>& tangents = isDeformed ? deformed.tangents : primitive.tangents;
  dmat4 m = instance.worldFromMesh;
  // Primitives of a skinned mesh that have no joints follow the node.
  if (const int node = scene_.meshes[meshIndex].node; isDeformed && instance.node < 0 && node >= 0 &&
                                                      scene_.meshes[meshIndex].skin >= 0 &&
                                                      primitive.deformation->influences == 0)
    m = glm::translate(dmat4(1.0), shifts_[part.object]) * pose_.worldFromNode[std::size_t(node)];
  const dmat3 l(m);
  const double sign = isMirroring(m) ? -1 : 1;
  const dmat3 normalMatrix =
      sign * dmat3(glm::cross(l[1], l[2]), glm::cross(l[2], l[0]), glm::cross(l[0], l[1]));
  core::parallelFor(part.vertexCount, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = part.firstVertex + begin; i < part.firstVertex + end; ++i) {
      const std::uint32_t v = world_.sourceVertices[i];
      const vec3 position(dvec3(m * dvec4(dvec3(positions[v]), 1.0)));
      if (!isUsable(position)) continue;  // what leaves all numbers stays where it was
      world_.positions[i] = position;
      world_.normals[i] =
          vec3(moveDirection(dmat4(normalMatrix), dvec3(normals[v]), dvec3(world_.normals[i])));
      if (v < tangents.size())
        world_.tangents[i] =
            vec4(vec3(moveDirection(m, dvec3(vec3(tangents[v])), dvec3(vec3(world_.tangents[i])))),
                 float(sign) * tangents[v].w);
    }
  });
}

void WorldMotion::turnWinding(const Part& part) {
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
    std::swap(world_.indices[i + 1], world_.indices[i + 2]);
}

void WorldMotion::setTime(double timeS) {
  // 1
  computePose(scene_.motion, choice_, timeS, pose_);
  isPosed_ = true;
  // 2. An instance that begins or ceases to mirror turns the winding of its triangles round.
  for (std::size_t i = 0; i < wasMirroring_.size(); ++i)
    wasMirroring_[i] = isMirroring(scene_.instances[i].worldFromMesh);
  placeInstances();
  placeCamerasAndLights();
  // 3
  deformMeshes();
  // 4
  for (const std::uint32_t p : movingParts_) {
    const Part& part = world_.parts[p];
    writePart(part);
    if (isMirroring(scene_.instances[part.object].worldFromMesh) != wasMirroring_[part.object])
      turnWinding(part);
  }
  // 5
  measureParts(movingParts_);
}

void WorldMotion::measureParts(std::span<const std::uint32_t> parts) {
  world_.bounds = {};
  for (const vec3& p : world_.positions) world_.bounds.add(dvec3(p));
  for (const std::uint32_t p : parts)
    if (world_.parts[p].reflector != core::kNoId)
      measureReflectorAgain(scene_, world_, world_.parts[p].reflector, options_);
}

std::span<const std::uint32_t> WorldMotion::shiftInstance(std::uint32_t instance, const dvec3& shift) {
  shiftedParts_.clear();
  if (shifts_[instance] == shift) return shiftedParts_;
  shifts_[instance] = shift;
  scene_.instances[instance].worldFromMesh = glm::translate(dmat4(1.0), shift) * placements_[instance];
  for (std::uint32_t p = 0; p < world_.parts.size(); ++p) {
    if (world_.parts[p].object != instance) continue;
    writePart(world_.parts[p]);
    shiftedParts_.push_back(p);
  }
  measureParts(shiftedParts_);
  return shiftedParts_;
}

bool WorldMotion::movesOnlyCameras() const {
  return movingParts_.empty() && std::none_of(scene_.lights.begin(), scene_.lights.end(),
                                              [this](const Light& light) { return moves(light.node); });
}

}  // namespace catoptric::scene
