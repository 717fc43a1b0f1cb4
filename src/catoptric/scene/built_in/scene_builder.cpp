// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/scene_builder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtx/spline.hpp>
#include <utility>

namespace catoptric::scene::built_in {
namespace {

bool needsUv(const Material& m, int uvSet) {
  for (const TextureSlot* slot : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                                  &m.occlusionTexture, &m.emissiveTexture})
    if (slot->texture >= 0 && slot->uvSet == uvSet) return true;
  return false;
}

}  // namespace

int SceneBuilder::addTexture(const std::string& name, core::ImageRgba8 image, Wrap wrap) {
  Texture texture;
  texture.name = name;
  texture.image = std::move(image);
  texture.wrapU = texture.wrapV = wrap;
  scene_.textures.push_back(std::move(texture));
  return int(scene_.textures.size()) - 1;
}

int SceneBuilder::addMaterial(const std::string& name, const vec3& linearColour, float metallic,
                              float roughness) {
  const auto [entry, isNew] = materialByName_.try_emplace(name, int(scene_.materials.size()));
  if (!isNew) return entry->second;
  Material m;
  m.name = name;
  m.baseColor = vec4(linearColour, 1);
  m.metallic = metallic;
  m.roughness = roughness;
  scene_.materials.push_back(m);
  return entry->second;
}

int SceneBuilder::paint(const std::string& name, const vec3& linearColour, float roughness) {
  return addMaterial(name, linearColour, 0.0f, roughness);
}

int SceneBuilder::metal(const std::string& name, const vec3& linearColour, float roughness) {
  return addMaterial(name, linearColour, 1.0f, roughness);
}

int SceneBuilder::textured(const std::string& name, const ivec2& sizePx, const Pattern& pattern,
                           float roughness, int samplesPerAxis) {
  if (const auto found = materialByName_.find(name); found != materialByName_.end()) return found->second;
  const int index = paint(name, vec3(1), roughness);
  material(index).baseColorTexture.texture =
      addTexture(name, paintTexture(sizePx.x, sizePx.y, pattern, samplesPerAxis));
  return index;
}

int SceneBuilder::mirror(const std::string& name, const vec3& tint) {
  return metal(name, tint, 0.0f);
}

int SceneBuilder::glow(const std::string& name, const vec3& radiance) {
  const int index = paint(name, vec3(0), 1.0f);
  material(index).emissive = radiance;
  return index;
}

void SceneBuilder::setOcclusion(int index, const std::string& name, core::ImageRgba8 image, int uvSet) {
  const int texture = addTexture(name, std::move(image), Wrap::ClampToEdge);
  material(index).occlusionTexture.texture = texture;
  material(index).occlusionTexture.uvSet = uvSet;
}

int SceneBuilder::addMesh(const std::string& name, std::span<const Piece> pieces) {
  Mesh mesh;
  mesh.name = name;
  std::map<int, std::size_t> primitiveOf;  // pieces of one material are drawn as one
  std::vector<geometry::Mesh> merged;
  std::vector<int> materials;
  for (const Piece& piece : pieces) {
    const auto [entry, isNew] = primitiveOf.try_emplace(piece.material, merged.size());
    if (isNew) {
      merged.emplace_back();
      materials.push_back(piece.material);
    }
    geometry::append(merged[entry->second], piece.mesh);
  }
  for (std::size_t i = 0; i < merged.size(); ++i) {
    geometry::Mesh& from = merged[i];
    MeshPrimitive to;
    to.positions = std::move(from.positions);
    to.normals = std::move(from.normals);
    if (needsUv(material(materials[i]), 0)) to.uv[0] = std::move(from.uv);
    if (needsUv(material(materials[i]), 1)) {
      if (to.uv[0].empty()) to.uv[0] = from.uv;  // TEXCOORD_1 needs a TEXCOORD_0 beside it
      to.uv[1] = std::move(from.uv1);
    }
    to.colors = std::move(from.colors);
    to.indices = std::move(from.indices);
    to.material = materials[i];
    mesh.primitives.push_back(std::move(to));
  }
  scene_.meshes.push_back(std::move(mesh));
  return int(scene_.meshes.size()) - 1;
}

Instance& SceneBuilder::place(const std::string& name, int mesh, const dmat4& worldFromMesh) {
  Instance instance;
  instance.name = name;
  instance.mesh = mesh;
  instance.worldFromMesh = worldFromMesh;
  scene_.instances.push_back(instance);
  return scene_.instances.back();
}

Instance& SceneBuilder::place(const std::string& name, std::span<const Piece> pieces,
                              const dmat4& worldFromMesh) {
  return place(name, addMesh(name, pieces), worldFromMesh);
}

Instance& SceneBuilder::place(const std::string& name, geometry::Mesh mesh, int material,
                              const dmat4& worldFromMesh) {
  const Piece piece{std::move(mesh), material};
  return place(name, std::span<const Piece>(&piece, 1), worldFromMesh);
}

Instance& SceneBuilder::placeShell(const std::string& name, geometry::Mesh mesh, int material,
                                   const dmat4& worldFromMesh) {
  Instance& instance = place(name, std::move(mesh), material, worldFromMesh);
  instance.hint.shell = true;
  return instance;
}

void SceneBuilder::moveAlong(Instance& instance, std::span<const float> timesS, std::span<const vec3> places,
                             double turnDegrees) {
  MotionNode node;
  node.name = instance.name;
  node.translation = dvec3(places.front());
  node.rotation = glm::angleAxis(glm::radians(turnDegrees), dvec3(0, 1, 0));
  instance.node = int(scene_.motion.nodes.size());
  scene_.motion.order.push_back(instance.node);
  scene_.motion.nodes.push_back(node);
  if (scene_.motion.animations.empty()) scene_.motion.animations.push_back({"motion", 0, {}});
  Animation& animation = scene_.motion.animations.front();
  AnimationChannel channel;
  channel.node = instance.node;
  channel.timesS.assign(timesS.begin(), timesS.end());
  for (const vec3& place : places) channel.values.insert(channel.values.end(), {place.x, place.y, place.z});
  animation.durationS = std::max(animation.durationS, double(timesS.back()));
  animation.channels.push_back(channel);
}

void SceneBuilder::addSun(const dvec3& towardsLight, const vec3& color) {
  Light light;
  light.type = LightType::Directional;
  light.direction = vec3(-glm::normalize(towardsLight));
  light.color = color;
  scene_.lights.push_back(light);
}

void SceneBuilder::addLamp(const dvec3& position, const vec3& color, double range) {
  Light light;
  light.position = vec3(position);
  light.color = color;
  light.range = float(range);
  scene_.lights.push_back(light);
}

void SceneBuilder::addCamera(const std::string& name, const dvec3& eye, const dvec3& target,
                             double fovYDegrees) {
  Camera camera;
  camera.name = name;
  camera.eye = eye;
  camera.target = target;
  camera.fovYRadians = glm::radians(fovYDegrees);
  scene_.cameras.push_back(camera);
}

void SceneBuilder::addWalk(const std::string& name, std::span<const Station> stations, double durationS,
                           double fovYDegrees) {
  constexpr int kKeysPerStation = 8;  // key frames are joined by straight lines
  assert(stations.size() >= 2);
  addCamera(name, stations[0].eye, stations[0].target, fovYDegrees);
  const int node = int(scene_.motion.nodes.size());
  scene_.cameras.back().node = node;
  scene_.motion.order.push_back(node);
  AnimationChannel place{.node = node, .timesS = {}, .values = {}};
  AnimationChannel turn{
      .node = node, .property = AnimatedProperty::Rotation, .width = 4, .timesS = {}, .values = {}};
  const int last = int(stations.size()) - 1;
  for (int key = 0; key <= last * kKeysPerStation; ++key) {
    const double at = double(key) / kKeysPerStation, t = at - std::min(std::floor(at), last - 1.0);
    const auto station = [&](int offset) {
      return stations[std::size_t(std::clamp(int(at - t) + offset, 0, last))];
    };
    const auto curve = [&](dvec3 Station::*point) {
      return glm::catmullRom(station(-1).*point, station(0).*point, station(1).*point, station(2).*point, t);
    };
    const dvec3 eye = curve(&Station::eye), target = curve(&Station::target);
    const glm::dquat q = glm::quat_cast(glm::inverse(dmat3(glm::lookAt(eye, target, dvec3(0, 1, 0)))));
    for (AnimationChannel* channel : {&place, &turn}) channel->timesS.push_back(float(durationS * at / last));
    place.values.insert(place.values.end(), {float(eye.x), float(eye.y), float(eye.z)});
    turn.values.insert(turn.values.end(), {float(q.x), float(q.y), float(q.z), float(q.w)});
  }
  const std::vector<float>& q = turn.values;
  scene_.motion.nodes.push_back({.name = name,
                                 .translation = stations[0].eye,
                                 .rotation = glm::dquat(q[3], q[0], q[1], q[2]),
                                 .weights = {}});
  scene_.motion.animations.push_back({name, durationS, {place, turn}});
}

}  // namespace catoptric::scene::built_in
