// SPDX-License-Identifier: Apache-2.0
// Where every node stands at a time.
//
//   1. Each channel finds the key frames before and after the time and interpolates (glTF 2.0, appendix C):
//      step; linear, the shorter great arc for rotations; Hermite spline with tangents times the key frames'
//      distance, rotations normalised afterwards. Before the first and after the last key frame the value
//      stands still.
//   2. Properties that no channel drives keep their rest value.
//   3. World matrices from parents to children.
//
// Cost: a binary search and a few products for each channel; nothing is allocated after the first call.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catoptric/scene/motion.h"

namespace catoptric::scene {

/// Writes the value of a channel at `timeS`; `out` has `width` floats.
void evaluateChannel(const AnimationChannel& channel, double timeS, std::span<float> out);

/// Which channels play.
struct MotionChoice {
  std::vector<const AnimationChannel*> channels;
  std::vector<std::string> animations;  ///< names of those that play
  double durationS = 0;                 ///< of the longest
};

/// The animation called `name`, or with that index; with an empty name every animation that drives nothing
/// that an earlier one drives. Throws core::Error("animation.unknown").
[[nodiscard]] MotionChoice chooseAnimations(const Motion& motion, const std::string& name);

struct Pose {
  struct Transform {
    dvec3 translation;
    glm::dquat rotation;
    dvec3 scale;
  };
  std::vector<Transform> transforms;  ///< relative to the parent
  std::vector<dmat4> worldFromNode;
  std::vector<std::vector<float>> weights;  ///< of each node's morph targets
};

void computePose(const Motion& motion, const MotionChoice& choice, double timeS, Pose& pose);

}  // namespace catoptric::scene
