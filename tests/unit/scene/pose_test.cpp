// SPDX-License-Identifier: Apache-2.0
// Key frames, node trees, morphing and skinning against values computed by hand.
#include "catoptric/scene/pose.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "catoptric/core/error.h"
#include "catoptric/scene/deformation.h"

namespace catoptric::scene {
namespace {

AnimationChannel makeChannel(Interpolation interpolation, std::vector<float> times,
                             std::vector<float> values) {
  return {.node = 0,
          .property = AnimatedProperty::Translation,
          .interpolation = interpolation,
          .width = 3,
          .timesS = std::move(times),
          .values = std::move(values)};
}

vec3 valueAt(const AnimationChannel& channel, double timeS) {
  std::array<float, 3> out{};
  evaluateChannel(channel, timeS, out);
  return {out[0], out[1], out[2]};
}

TEST(Pose, stepHoldsAndLinearMixes) {
  const std::vector<float> values{0, 0, 0, 2, 4, 6, 2, 0, 0};
  const AnimationChannel step = makeChannel(Interpolation::Step, {1, 2, 4}, values);
  const AnimationChannel linear = makeChannel(Interpolation::Linear, {1, 2, 4}, values);
  EXPECT_EQ(valueAt(step, 1.99), vec3(0));
  EXPECT_EQ(valueAt(step, 2.0), vec3(2, 4, 6));
  EXPECT_EQ(valueAt(linear, 1.25), vec3(0.5f, 1, 1.5f));
  EXPECT_EQ(valueAt(linear, 3.0), vec3(2, 2, 3));
  for (const AnimationChannel& channel : {step, linear}) {
    EXPECT_EQ(valueAt(channel, -5), vec3(0));  // nothing before the first key frame, nor after the last
    EXPECT_EQ(valueAt(channel, 0.5), vec3(0));
    EXPECT_EQ(valueAt(channel, 99), vec3(2, 0, 0));
  }
}

TEST(Pose, oneKeyFrameHoldsForever) {
  for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear})
    for (const double t : {0.0, 1.0, 2.0})
      EXPECT_EQ(valueAt(makeChannel(interpolation, {1}, {7, 8, 9}), t), vec3(7, 8, 9));
}

TEST(Pose, splineIsThatOfTheSpecification) {
  // In-tangent, value, out-tangent; two seconds between the key frames.
  const AnimationChannel spline = makeChannel(Interpolation::CubicSpline, {0, 2},
                                              {9, 9, 9, 1, 0, 0, 0.5f, 1, 0, -0.5f, 0, 1, 3, 0, 0, 9, 9, 9});
  EXPECT_EQ(valueAt(spline, 0), vec3(1, 0, 0));
  EXPECT_EQ(valueAt(spline, 2), vec3(3, 0, 0));
  // t = 1/2: (1/2) p0 + (1/8) 2 m0 + (1/2) p1 - (1/8) 2 m1
  const vec3 middle = valueAt(spline, 1);
  EXPECT_NEAR(middle.x, 0.5 + 0.125 + 1.5 + 0.125, 1e-6);
  EXPECT_NEAR(middle.y, 0.25, 1e-6);
  EXPECT_NEAR(middle.z, -0.25, 1e-6);
  // Its slope at the key frames is the tangent.
  EXPECT_NEAR((valueAt(spline, 1e-3).y - valueAt(spline, 0).y) / 1e-3, 1.0, 5e-3);
}

TEST(Pose, rotationsTakeTheShorterArc) {
  const float h = std::sqrt(0.5f);
  AnimationChannel turn{.node = 0,
                        .property = AnimatedProperty::Rotation,
                        .interpolation = Interpolation::Linear,
                        .width = 4,
                        .timesS = {0, 1},
                        .values = {0, 0, 0, 1, 0, 0, -h, -h}};  // 90 degrees about z, with the other sign
  std::array<float, 4> q{};
  evaluateChannel(turn, 1.0 / 3.0, q);
  EXPECT_NEAR(std::abs(q[3]), std::cos(glm::radians(15.0)), 1e-6);
  EXPECT_NEAR(std::abs(q[2]), std::sin(glm::radians(15.0)), 1e-6);
  EXPECT_GT(q[2] * q[3], 0);
}

Motion makeChain() {
  Motion motion;
  motion.nodes = {{.name = "root", .parent = -1, .translation = {1, 0, 0}, .weights = {}},
                  {.name = "tip", .parent = 0, .translation = {0, 2, 0}, .weights = {}}};
  motion.order = {0, 1};
  const float h = std::sqrt(0.5f);
  const AnimationChannel turn{0,      AnimatedProperty::Rotation, Interpolation::Linear, 4,
                              {0, 1}, {0, 0, 0, 1, 0, 0, h, h}};
  const AnimationChannel move{
      1, AnimatedProperty::Translation, Interpolation::Linear, 3, {0, 2}, {0, 2, 0, 0, 4, 0}};
  motion.animations = {{"turn", 1, {turn}}, {"move", 2, {move}}, {"turn again", 1, {turn, move}}};
  return motion;
}

TEST(Pose, childrenFollowTheirParents) {
  const Motion motion = makeChain();
  Pose pose;
  computePose(motion, {}, 1, pose);  // nothing plays
  EXPECT_EQ(dvec3(pose.worldFromNode[1][3]), dvec3(1, 2, 0));
  computePose(motion, chooseAnimations(motion, ""), 1, pose);
  EXPECT_NEAR(pose.worldFromNode[1][3].x, 1 - 3, 1e-6);  // 90 degrees about z carry +y to -x
  EXPECT_NEAR(pose.worldFromNode[1][3].y, 0, 1e-6);
}

TEST(Pose, animationsThatDriveTheSameThingDoNotPlayTogether) {
  const Motion motion = makeChain();
  EXPECT_EQ(chooseAnimations(motion, "").animations, (std::vector<std::string>{"turn", "move"}));
  EXPECT_EQ(chooseAnimations(motion, "").durationS, 2);
  EXPECT_EQ(chooseAnimations(motion, "turn again").channels.size(), 2u);
  EXPECT_EQ(chooseAnimations(motion, "1").animations.front(), "move");
  EXPECT_THROW((void)chooseAnimations(motion, "walk"), core::Error);
  EXPECT_THROW((void)chooseAnimations(Motion{}, "0"), core::Error);
}

TEST(Deform, targetsAddUp) {
  Deformation source;
  source.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  source.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  source.targets = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}, {}},
                    {{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{1, 0, -1}, {}, {}}, {}}};
  DeformedVertices out;
  deform(source, std::array{0.5f, 2.0f}, {}, out);
  EXPECT_EQ(out.positions[0], vec3(2, 0, 0.5f));
  EXPECT_EQ(out.positions[1], vec3(1, 0, 0.5f));
  EXPECT_NEAR(out.normals[0].x, 2 / std::sqrt(5.0), 1e-6);  // (0,0,1) + 2 (1,0,-1)
  EXPECT_NEAR(out.normals[0].z, -1 / std::sqrt(5.0), 1e-6);
  deform(source, {}, {}, out);  // missing weights are zero
  EXPECT_EQ(out.positions, source.positions);
  EXPECT_EQ(out.normals, source.normals);
}

TEST(Deform, jointsAreBlendedByWeight) {
  Deformation source;
  source.positions = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  source.normals = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  source.influences = 2;
  source.joints = {0, 1, 0, 1, 0, 1};
  source.jointWeights = {1, 0, 0, 1, 0.5f, 0.5f};
  const dmat4 turned = glm::rotate(dmat4(1.0), glm::radians(90.0), dvec3(0, 0, 1));
  const dmat4 moved = glm::translate(dmat4(1.0), dvec3(0, 0, 4));
  DeformedVertices out;
  deform(source, {}, std::array{turned, moved}, out);
  EXPECT_NEAR(glm::length(out.positions[0] - vec3(0, 1, 0)), 0, 1e-6);
  EXPECT_EQ(out.positions[1], vec3(1, 0, 4));
  EXPECT_NEAR(glm::length(out.positions[2] - vec3(0.5f, 0.5f, 2)), 0, 1e-6);
  EXPECT_NEAR(glm::length(out.normals[0] - vec3(0, 1, 0)), 0, 1e-6);
  for (const vec3& n : out.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
}

TEST(Deform, withoutNormalsTheyAreThoseOfTheTriangles) {
  Deformation source;
  source.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  source.targets = {{{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}, {}, {}}};
  DeformedVertices out;
  deform(source, {}, {}, out);
  EXPECT_EQ(out.normals[2], vec3(0, 0, 1));
  deform(source, std::array{1.0f}, {}, out);
  EXPECT_NEAR(out.normals[2].x, -std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace catoptric::scene
