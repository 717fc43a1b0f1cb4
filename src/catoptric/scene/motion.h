// SPDX-License-Identifier: Apache-2.0
// What moves in a scene: the tree of nodes that places its instances, cameras and lights, the skins and morph
// targets that deform its meshes, and key frames that drive both, as in glTF 2.0. Empty unless the file has
// animations. pose.h evaluates it, world_motion.h carries it into the world geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::scene {

enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
enum class AnimatedProperty : std::uint8_t { Translation, Rotation, Scale, Weights };

/// Key frames of one property of one node.
struct AnimationChannel {
  int node = -1;
  AnimatedProperty property = AnimatedProperty::Translation;
  Interpolation interpolation = Interpolation::Linear;
  std::size_t width =
      3;  ///< floats in a value: 3, 4 (a unit quaternion x y z w), or one for each morph target
  std::vector<float> timesS;  ///< increasing, not negative, never empty
  std::vector<float>
      values;  ///< `width` for each time; cubic: in-tangent, value, out-tangent of `width` each
};

struct Animation {
  std::string name;
  double durationS = 0;  ///< the last key frame's time
  std::vector<AnimationChannel> channels;
};

struct MotionNode {
  std::string name;
  int parent = -1;
  dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  dvec3 scale{1};
  dmat4 matrix{1.0};  ///< instead of the three above, where `hasMatrix`
  bool hasMatrix = false;
  std::vector<float> weights;  ///< of its mesh's morph targets, at rest
};

struct SkinBinding {
  std::vector<int> joints;             ///< nodes
  std::vector<dmat4> jointFromVertex;  ///< inverse bind matrices, one for each joint
};

/// What the vertices of one MeshPrimitive are made from, in their order; see deform().
struct Deformation {
  struct Target {
    std::vector<vec3> positions, normals, tangents;  ///< differences; empty where the target has none
  };
  std::vector<vec3> positions,
      normals;  ///< before morphing and skinning; no normals: they are those of the triangles
  std::vector<vec4> tangents;
  std::vector<Target> targets;
  std::size_t influences = 0;         ///< joints of each vertex; 0 where only targets deform it
  std::vector<std::uint32_t> joints;  ///< `influences` for each vertex
  std::vector<float> jointWeights;    ///< likewise, with the sum 1
};

struct Motion {
  std::vector<MotionNode> nodes;
  std::vector<int> order;  ///< all nodes, parents before children
  std::vector<SkinBinding> skins;
  std::vector<Animation> animations;

  [[nodiscard]] bool isEmpty() const { return animations.empty(); }
};

}  // namespace catoptric::scene
