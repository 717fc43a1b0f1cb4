// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "catoptric/core/error.h"

namespace catoptric::scene {
namespace {

glm::dquat quaternionOf(std::span<const float> v) {
  return glm::dquat(v[3], v[0], v[1], v[2]);
}

void storeUnit(const glm::dquat& q, std::span<float> out) {
  const double length = glm::length(q);
  const glm::dquat unit = length > 0 ? q / length : glm::dquat(1, 0, 0, 0);
  out[0] = float(unit.x), out[1] = float(unit.y), out[2] = float(unit.z), out[3] = float(unit.w);
}

/// Along the shorter great arc; nearly equal ones along the chord, where the arc's sine is no divisor.
glm::dquat interpolateRotation(const glm::dquat& a, glm::dquat b, double t) {
  double cosine = glm::dot(a, b);
  if (cosine < 0) b = -b, cosine = -cosine;
  if (cosine > 0.9999) return a * (1 - t) + b * t;
  const double angle = std::acos(cosine);
  return (a * std::sin((1 - t) * angle) + b * std::sin(t * angle)) / std::sin(angle);
}

/// Step 1 between key frames k and k + 1, t in 0..1 and seconds apart.
void interpolate(const AnimationChannel& channel, std::size_t k, double t, double seconds,
                 std::span<float> out) {
  const std::size_t width = channel.width,
                    perFrame = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
  const auto value = [&](std::size_t frame, std::size_t which) {
    return std::span(channel.values).subspan((frame * perFrame + which) * width, width);
  };
  const bool isRotation = channel.property == AnimatedProperty::Rotation;
  if (channel.interpolation == Interpolation::CubicSpline) {
    const auto p0 = value(k, 1), m0 = value(k, 2), p1 = value(k + 1, 1), m1 = value(k + 1, 0);
    const double t2 = t * t, t3 = t2 * t;
    for (std::size_t i = 0; i < width; ++i)
      out[i] = float((2 * t3 - 3 * t2 + 1) * p0[i] + (t3 - 2 * t2 + t) * seconds * m0[i] +
                     (3 * t2 - 2 * t3) * p1[i] + (t3 - t2) * seconds * m1[i]);
    if (isRotation) storeUnit(quaternionOf(out), out);
    return;
  }
  const auto a = value(k, 0), b = value(k + 1, 0);
  if (isRotation) {
    storeUnit(interpolateRotation(quaternionOf(a), quaternionOf(b), t), out);
    return;
  }
  for (std::size_t i = 0; i < width; ++i) out[i] = float((1 - t) * a[i] + t * b[i]);
}

dmat4 composeMatrix(const dvec3& translation, const glm::dquat& rotation, const dvec3& scale) {
  return glm::scale(glm::translate(dmat4(1.0), translation) * glm::mat4_cast(rotation), scale);
}

[[noreturn]] void failUnknown(const Motion& motion, const std::string& name) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < motion.animations.size() && i < 8; ++i)
    known.push_back(fmt::format("{} \"{}\"", i, motion.animations[i].name));
  throw core::Error("animation.unknown", "there is no animation \"" + name + "\"", {},
                    known.empty() ? "the scene has no animations"
                                  : fmt::format("the scene has {}", fmt::join(known, ", ")));
}

std::size_t findAnimation(const Motion& motion, const std::string& name) {
  for (std::size_t i = 0; i < motion.animations.size(); ++i)
    if (motion.animations[i].name == name) return i;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (error != std::errc{} || end != name.data() + name.size() || index >= motion.animations.size())
    failUnknown(motion, name);
  return index;
}

}  // namespace

void evaluateChannel(const AnimationChannel& channel, double timeS, std::span<float> out) {
  const std::vector<float>& times = channel.timesS;
  const std::size_t perFrame = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
  const auto hold = [&](std::size_t frame) {
    const std::size_t first = (frame * perFrame + (perFrame == 3 ? 1 : 0)) * channel.width;
    std::copy_n(channel.values.begin() + std::ptrdiff_t(first), channel.width, out.begin());
  };
  const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), timeS,
                                                  [](double t, float key) { return t < double(key); }) -
                                 times.begin());
  if (after == 0) return hold(0);
  if (after == times.size() || channel.interpolation == Interpolation::Step) return hold(after - 1);
  const double start = times[after - 1], seconds = times[after] - start;
  interpolate(channel, after - 1, (timeS - start) / seconds, seconds, out);
}

MotionChoice chooseAnimations(const Motion& motion, const std::string& name) {
  MotionChoice choice;
  std::set<std::pair<int, AnimatedProperty>> driven;
  const auto add = [&](const Animation& animation) {
    for (const AnimationChannel& channel : animation.channels) {
      choice.channels.push_back(&channel);
      driven.emplace(channel.node, channel.property);
    }
    choice.animations.push_back(animation.name);
    choice.durationS = std::max(choice.durationS, animation.durationS);
  };
  if (!name.empty()) {
    add(motion.animations[findAnimation(motion, name)]);
    return choice;
  }
  for (const Animation& animation : motion.animations)
    if (std::none_of(animation.channels.begin(), animation.channels.end(),
                     [&](const AnimationChannel& channel) {
                       return driven.count({channel.node, channel.property}) != 0;
                     }))
      add(animation);
  return choice;
}

void computePose(const Motion& motion, const MotionChoice& choice, double timeS, Pose& pose) {
  const std::size_t count = motion.nodes.size();
  pose.worldFromNode.resize(count);
  pose.weights.resize(count);
  std::vector<Pose::Transform>& posed = pose.transforms;
  posed.resize(count);
  // 2
  for (std::size_t i = 0; i < count; ++i) {
    const MotionNode& node = motion.nodes[i];
    posed[i] = {node.translation, node.rotation, node.scale};
    pose.weights[i].assign(node.weights.begin(), node.weights.end());
  }
  // 1
  std::array<float, 4> value{};
  for (const AnimationChannel* channel : choice.channels) {
    const auto node = std::size_t(channel->node);
    if (channel->property == AnimatedProperty::Weights) {
      pose.weights[node].resize(channel->width);
      evaluateChannel(*channel, timeS, pose.weights[node]);
      continue;
    }
    evaluateChannel(*channel, timeS, std::span(value).first(channel->width));
    if (channel->property == AnimatedProperty::Rotation)
      posed[node].rotation = glm::normalize(quaternionOf(value));
    else
      (channel->property == AnimatedProperty::Translation ? posed[node].translation : posed[node].scale) =
          dvec3(value[0], value[1], value[2]);
  }
  // 3
  for (const int i : motion.order) {
    const MotionNode& node = motion.nodes[std::size_t(i)];
    const Pose::Transform& p = posed[std::size_t(i)];
    const dmat4 local = node.hasMatrix ? node.matrix : composeMatrix(p.translation, p.rotation, p.scale);
    pose.worldFromNode[std::size_t(i)] =
        node.parent < 0 ? local : pose.worldFromNode[std::size_t(node.parent)] * local;
  }
}

}  // namespace catoptric::scene
