// SPDX-License-Identifier: Apache-2.0
// The structure of animations: samplers, channels, the accessors they name. Key frames themselves are read
// and checked by motion.h, with the geometry.
#include <fmt/format.h>

#include <optional>
#include <set>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

struct AnimationSampler {
  int input = -1, output = -1;
  Interpolation interpolation = Interpolation::Linear;

  [[nodiscard]] bool isCubic() const { return interpolation == Interpolation::CubicSpline; }
};

void checkTight(const Element& where, const Model& model, const Accessor& accessor) {
  if (accessor.bufferView >= 0 && model.bufferViews[std::size_t(accessor.bufferView)].byteStride != 0)
    where.fail("gltf.accessor_stride", "key frames must not lie in a buffer view with a stride");
}

AnimationSampler readSampler(const Element& element, const Model& model) {
  AnimationSampler sampler;
  sampler.input = element.getIndex("input", model.accessors.size(), "accessor");
  sampler.output = element.getIndex("output", model.accessors.size(), "accessor");
  const std::string interpolation = element.findString("interpolation", "LINEAR");
  sampler.interpolation = interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                          : interpolation == "STEP"      ? Interpolation::Step
                                                         : Interpolation::Linear;
  if (sampler.interpolation == Interpolation::Linear && interpolation != "LINEAR")
    element.find("interpolation")
        ->fail("gltf.value", fmt::format("\"{}\" is no interpolation", printable(interpolation)));
  const Accessor& input = model.accessors[std::size_t(sampler.input)];
  if (input.element != ElementType::Scalar || input.component != ComponentType::Float)
    element.find("input")->fail("gltf.accessor_format", "the times of key frames must be floats");
  if (sampler.isCubic() && input.count < 2)
    element.find("input")->fail("gltf.value", "a cubic spline needs at least two key frames");
  checkTight(*element.find("input"), model, input);
  checkTight(*element.find("output"), model, model.accessors[std::size_t(sampler.output)]);
  return sampler;
}

/// Elements per key frame that the output must have, after checking its type.
std::size_t checkOutput(const Element& where, const Model& model, const Node& node, const std::string& path,
                        const Accessor& output) {
  const bool isFloat = output.component == ComponentType::Float;
  const bool isSmall = output.normalized && output.component != ComponentType::Uint32;
  const ElementType wanted = path == "weights"    ? ElementType::Scalar
                             : path == "rotation" ? ElementType::Vec4
                                                  : ElementType::Vec3;
  const bool mayBeSmall = path == "weights" || path == "rotation";
  if (output.element != wanted || !(isFloat || (mayBeSmall && isSmall)))
    where.fail("gltf.accessor_format",
               fmt::format("the accessor's type does not suit the animation of {}", path));
  return path == "weights" ? model.meshes[std::size_t(node.mesh)].primitives.front().targets.size() : 1;
}

AnimatedProperty propertyOf(const std::string& path) {
  return path == "translation" ? AnimatedProperty::Translation
         : path == "rotation"  ? AnimatedProperty::Rotation
         : path == "scale"     ? AnimatedProperty::Scale
                               : AnimatedProperty::Weights;
}

std::optional<ChannelSource> readChannel(const Element& element, const Model& model,
                                         const std::vector<AnimationSampler>& samplers,
                                         std::set<std::pair<int, std::string>>& targets) {
  const AnimationSampler& sampler =
      samplers[std::size_t(element.getIndex("sampler", samplers.size(), "sampler"))];
  const Element target = element.getObject("target");
  const std::string path = target.getString("path");
  const int node = target.findIndex("node", model.nodes.size(), "node");
  const bool isTransform = path == "translation" || path == "rotation" || path == "scale";
  if (node < 0 || !(isTransform || path == "weights"))
    return std::nullopt;  // a path of an extension is to be ignored
  if (!targets.emplace(node, path).second)
    target.fail("gltf.duplicate",
                fmt::format("two channels of the animation drive the {} of node {}", path, node));
  const Node& driven = model.nodes[std::size_t(node)];
  if (isTransform && driven.hasMatrix)
    target.fail("gltf.value", fmt::format("node {} has a matrix, which cannot be animated", node));
  if (path == "weights" &&
      (driven.mesh < 0 || model.meshes[std::size_t(driven.mesh)].primitives.front().targets.empty()))
    target.fail("gltf.value",
                fmt::format("node {} has no morph targets whose weights could be animated", node));
  const Accessor& output = model.accessors[std::size_t(sampler.output)];
  const std::size_t values = checkOutput(*element.find("sampler"), model, driven, path, output);
  const std::size_t perFrame = values * (sampler.isCubic() ? 3 : 1);
  const std::size_t frames = model.accessors[std::size_t(sampler.input)].count;
  if (output.count % perFrame != 0 || output.count / perFrame != frames)
    element.find("sampler")->fail(
        "gltf.value",
        fmt::format("{} key frames need {} values each, found {} values", frames, perFrame, output.count));
  return ChannelSource{.node = node,
                       .input = sampler.input,
                       .output = sampler.output,
                       .property = propertyOf(path),
                       .interpolation = sampler.interpolation,
                       .width = path == "weights" ? values : componentCount(output.element)};
}

}  // namespace

void readAnimations(Context&, const Element& root, Model& model) {
  forEachObject(root, "animations", [&](const Element& element, std::size_t) {
    AnimationSource animation{.name = element.findString("name"), .channels = {}};
    std::vector<AnimationSampler> samplers;
    (void)element.getArray("samplers");
    forEachObject(element, "samplers", [&](const Element& sampler, std::size_t) {
      samplers.push_back(readSampler(sampler, model));
    });
    (void)element.getArray("channels");
    std::set<std::pair<int, std::string>> targets;
    forEachObject(element, "channels", [&](const Element& channel, std::size_t) {
      if (const auto source = readChannel(channel, model, samplers, targets))
        animation.channels.push_back(*source);
    });
    if (!animation.channels.empty()) model.animations.push_back(std::move(animation));
  });
}

}  // namespace catoptric::scene::gltf
