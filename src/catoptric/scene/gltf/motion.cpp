// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/gltf/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catoptric/scene/gltf/placement.h"

namespace catoptric::scene::gltf {
namespace {

std::string pointerTo(int accessor) {
  return fmt::format("/accessors/{}", accessor);
}

std::vector<float> readTimes(const Data& data, int accessor) {
  std::vector<float> times = data.readFloats(accessor);
  if (times.empty())
    data.context().fail("gltf.accessor_data", "an animation without key frames", pointerTo(accessor));
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!(times[i] >= 0 && std::isfinite(times[i])) || (i > 0 && times[i] <= times[i - 1]))
      data.context().fail(
          "gltf.accessor_data",
          fmt::format("the times of key frames must increase from 0 or later, key frame {} does not", i),
          pointerTo(accessor));
  return times;
}

/// Rotations to unit length; the tangents of splines are none.
void normalizeRotations(const Data& data, const ChannelSource& source, AnimationChannel& channel) {
  const std::size_t perFrame = source.interpolation == Interpolation::CubicSpline ? 3 : 1;
  for (std::size_t i = perFrame / 2; i < channel.values.size() / 4; i += perFrame) {
    float* q = &channel.values[4 * i];
    const double length =
        std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
    if (!(length > 1e-6))
      data.context().fail("gltf.accessor_data", fmt::format("rotation {} is zero", i),
                          pointerTo(source.output));
    if (std::abs(length - 1) > 1e-2) data.context().count(Repair::Rotation);
    for (int k = 0; k < 4; ++k) q[k] = float(q[k] / length);
  }
}

AnimationChannel readChannel(const Data& data, const ChannelSource& source) {
  AnimationChannel channel{.node = source.node,
                           .property = source.property,
                           .interpolation = source.interpolation,
                           .width = source.width,
                           .timesS = readTimes(data, source.input),
                           .values = data.readFloats(source.output)};
  for (std::size_t i = 0; i < channel.values.size(); ++i)
    if (!(std::abs(channel.values[i]) <= 1e30f))
      data.context().fail("gltf.accessor_data", fmt::format("number {} of the key frames is not finite", i),
                          pointerTo(source.output));
  if (source.property == AnimatedProperty::Rotation) normalizeRotations(data, source, channel);
  return channel;
}

void importNodes(const Model& model, Motion& motion) {
  for (const Node& node : model.nodes) {
    const std::vector<float>& weights =
        !node.weights.empty() || node.mesh < 0 ? node.weights : model.meshes[std::size_t(node.mesh)].weights;
    motion.nodes.push_back({.name = node.name,
                            .parent = node.parent,
                            .translation = node.translation,
                            .rotation = node.rotation,
                            .scale = node.scale,
                            .matrix = node.parentFromNode,
                            .hasMatrix = node.hasMatrix,
                            .weights = weights});
  }
  motion.order = collectNodes(model, {.name = {}, .nodes = model.roots});
}

}  // namespace

std::vector<dmat4> readInverseBindMatrices(const Data& data, const Skin& skin) {
  std::vector<float> floats;
  if (skin.inverseBindMatrices >= 0) floats = data.readFloats(skin.inverseBindMatrices);
  data.context().charge(skin.joints.size(), sizeof(dmat4));
  std::vector<dmat4> out;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    dmat4 jointFromVertex(1.0);
    for (std::size_t k = 0; k < 16 && !floats.empty(); ++k)
      jointFromVertex[int(k / 4)][int(k % 4)] = floats[16 * j + k];
    const bool isAffine = jointFromVertex[0][3] == 0 && jointFromVertex[1][3] == 0 &&
                          jointFromVertex[2][3] == 0 && jointFromVertex[3][3] == 1;
    if (!isAffine || !isFinite(jointFromVertex))
      data.context().fail("gltf.accessor_data",
                          fmt::format("inverse bind matrix {} is not affine and finite", j),
                          pointerTo(skin.inverseBindMatrices));
    out.push_back(jointFromVertex);
  }
  return out;
}

void importMotion(const Data& data, Scene& scene) {
  const Model& model = data.model();
  if (model.animations.empty()) return;
  data.context().charge(model.nodes.size(), sizeof(MotionNode) + sizeof(int) + sizeof(dmat4));
  importNodes(model, scene.motion);
  // Every skin is read, so that indices stay those of the file; a skin that nothing uses may be anything.
  std::vector<bool> isUsed(model.skins.size(), false);
  for (const Mesh& mesh : scene.meshes)
    if (mesh.skin >= 0) isUsed[std::size_t(mesh.skin)] = true;
  for (std::size_t i = 0; i < model.skins.size(); ++i) {
    SkinBinding binding;
    if (isUsed[i]) binding = {model.skins[i].joints, readInverseBindMatrices(data, model.skins[i])};
    scene.motion.skins.push_back(std::move(binding));
  }
  for (const AnimationSource& source : model.animations) {
    Animation animation{.name = source.name, .durationS = 0, .channels = {}};
    for (const ChannelSource& channel : source.channels) {
      animation.channels.push_back(readChannel(data, channel));
      animation.durationS = std::max(animation.durationS, double(animation.channels.back().timesS.back()));
    }
    scene.motion.animations.push_back(std::move(animation));
  }
}

}  // namespace catoptric::scene::gltf
