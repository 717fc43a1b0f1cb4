// SPDX-License-Identifier: Apache-2.0
// The eye walks, a box turns and flies, and the mirror breathes: each frame against the ray-traced one of the
// same moment. CATOPTRIC_MOVING_FRAMES=600 plays that many; a dozen by default.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "catoptric/geometry/shapes.h"
#include "catoptric/metrics/displacement.h"
#include "catoptric/scene/world_motion.h"
#include "image_test_support.h"
#include "traced_scene.h"

namespace catoptric::image_test {
namespace {

constexpr double kFps = 25;

int frameCount() {
  const char* wanted = std::getenv("CATOPTRIC_MOVING_FRAMES");
  return wanted == nullptr ? 12 : std::max(1, std::atoi(wanted));
}

/// Megabytes that this process has in memory.
double residentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * 4096e-6;
}

/// A ball whose morph target is an ellipsoid; vertices on ellipsoids have normals as their gradient.
scene::MeshPrimitive makeBreathingBall() {
  scene::MeshPrimitive ball = reference::makeBall(96, 48);
  const vec3 axes(1.25f, 0.8f, 1.1f);
  scene::Deformation deformation;
  deformation.positions = ball.positions;
  deformation.normals = ball.normals;
  scene::Deformation::Target target;
  for (const vec3& p : ball.positions) {
    target.positions.push_back(p * axes - p);
    target.normals.push_back(glm::normalize(p / axes) - p);
  }
  deformation.targets.push_back(target);
  ball.deformation = deformation;
  return ball;
}

void addMotion(scene::Scene& scene, int ball, int box) {
  scene.motion.nodes = {{.name = "ball", .weights = {0}}, {.name = "box", .weights = {}}};
  scene.motion.order = {0, 1};
  scene::Animation animation{"all", 24, {}};
  scene::AnimationChannel weights{0, scene::AnimatedProperty::Weights, scene::Interpolation::Linear, 1, {},
                                  {}};
  scene::AnimationChannel way{1, scene::AnimatedProperty::Translation, scene::Interpolation::Linear, 3, {},
                              {}};
  scene::AnimationChannel turn{1, scene::AnimatedProperty::Rotation, scene::Interpolation::Linear, 4, {}, {}};
  for (int key = 0; key <= 96; ++key) {
    const auto t = float(0.25 * key);
    for (scene::AnimationChannel* channel : {&weights, &way, &turn}) channel->timesS.push_back(t);
    weights.values.push_back(0.5f - 0.5f * std::cos(1.9f * t));
    way.values.insert(way.values.end(), {1.1f * std::sin(0.8f * t), 0.35f + 0.15f * std::sin(2.1f * t),
                                         1.15f + 0.3f * std::cos(0.8f * t)});
    turn.values.insert(turn.values.end(), {0, std::sin(0.6f * t), 0, std::cos(0.6f * t)});
  }
  animation.channels = {weights, way, turn};
  scene.motion.animations.push_back(animation);
  scene::Instance& ballInstance = scene.instances[std::size_t(ball)];
  ballInstance.nodeFromMesh = ballInstance.worldFromMesh;
  ballInstance.node = 0;
  scene.instances[std::size_t(box)].node = 1;
  scene.meshes[std::size_t(ballInstance.mesh)].node = 0;
}

struct MovingScene {
  reference::TracedTestScene t;
  MovingScene() {
    scene::Material paint;
    paint.metallic = 0;
    paint.baseColor = {0.9f, 0.45f, 0.2f, 1};
    scene::Material floor = paint;
    floor.baseColor = {0.5f, 0.55f, 0.6f, 1};
    const int ball = t.add(makeBreathingBall(), reference::makeMirror(vec3(0.95f)), "ball",
                           geometry::moveBy({0, 0.62, 0}) * geometry::scaleBy(dvec3(0.6)));
    const geometry::Mesh mesh = geometry::makeBox({0.35, 0.5, 0.35});
    scene::MeshPrimitive box;
    box.positions = mesh.positions, box.normals = mesh.normals, box.indices = mesh.indices;
    const int boxInstance = t.add(box, paint, "box");
    t.add(reference::makeQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), floor, "floor");
    addMotion(t.scene, ball, boxInstance);
    t.finish();
  }
};

scene::Camera cameraAt(double timeS) {
  scene::Camera camera;
  camera.eye = {3.2 * std::sin(0.3 * timeS), 1.3 + 0.4 * std::sin(0.7 * timeS), 3.2 * std::cos(0.3 * timeS)};
  camera.target = {0, 0.6, 0};
  camera.fovYRadians = 0.6;
  return camera;
}

/// Radiance of both, compared bit by bit.
void expectSame(const renderer::Frame& a, const renderer::Frame& b) {
  ASSERT_EQ(a.radiance.size(), b.radiance.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.radiance.size(); ++i)
    different += a.radiance.pixels()[i] != b.radiance.pixels()[i] ? 1 : 0;
  EXPECT_EQ(different, 0u);
}

TEST(DraggedFrames, areThoseOfARendererThatKeptNothing) {
  reference::TracedTestScene t;
  scene::Material paint;
  paint.metallic = 0;
  t.add(reference::makeBall(48, 24), reference::makeMirror(vec3(0.95f)), "ball",
        geometry::moveBy({0, 0.5, 0}) * geometry::scaleBy(dvec3(0.5)));
  const int thing = t.add(reference::makeBall(48, 24), paint, "thing",
                          geometry::moveBy({1.2, 0.2, 0.8}) * geometry::scaleBy(dvec3(0.2)));
  t.add(reference::makeQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), paint, "floor");
  t.finish();
  scene::WorldMotion motion(t.scene, t.world, {});
  renderer::Renderer dragged(t.scene, t.world, sky());
  const renderer::FrameOptions options{.method = renderer::Method::Virtual, .widthPx = 200, .heightPx = 150};
  (void)dragged.render(cameraAt(0), options);
  for (const int instance : {thing, 0})  // an object, then the mirror itself
    for (const double x : {0.1, -0.3, -0.8}) {
      const auto moved = motion.shiftInstance(std::uint32_t(instance), dvec3(x, 0, 0.05));
      ASSERT_FALSE(moved.empty());
      dragged.updateGeometry(moved);
      renderer::Renderer fresh(t.scene, t.world, sky());
      expectSame(dragged.render(cameraAt(0), options), fresh.render(cameraAt(0), options));
    }
}

/// The mirrors of the last frame get the new eye beside each other, all others when their turn comes.
TEST(MovedEye, isTheSameForMirrorsTogetherAndOneByOne) {
  reference::TracedTestScene t;
  scene::Material paint;
  paint.metallic = 0;
  for (const double x : {-0.9, 0.0, 0.7})
    t.add(reference::makeBall(48, 24), reference::makeMirror(vec3(0.95f)), "ball",
          geometry::moveBy({x, 0.4, 0}) * geometry::scaleBy(dvec3(0.3)));
  t.add(reference::makeBall(48, 24), paint, "thing",
        geometry::moveBy({0.3, 0.2, 0.9}) * geometry::scaleBy(dvec3(0.2)));
  t.add(reference::makeQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), paint, "floor");
  t.finish();
  renderer::Renderer together(t.scene, t.world, sky()), oneByOne(t.scene, t.world, sky());
  renderer::FrameOptions options{.method = renderer::Method::Virtual, .widthPx = 200, .heightPx = 150};
  renderer::FrameOptions none = options;
  none.method = renderer::Method::None;
  for (const double timeS : {0.0, 0.1, 0.4, 1.5}) {
    expectSame(together.render(cameraAt(timeS), options), oneByOne.render(cameraAt(timeS), options));
    (void)oneByOne.render(cameraAt(timeS), none);  // shows no mirror's virtual object
  }
}

TEST(MovingFrames, keepToTheTruth) {
  MovingScene m;
  scene::WorldMotion motion(m.t.scene, m.t.world, {});
  renderer::Renderer renderer(m.t.scene, m.t.world, sky());
  const int frames = frameCount();
  double worstP95 = 0, worstLost = 0, worstP95All = 0, settledMegabytes = 0;
  int withObject = 0;
  for (int i = 0; i < frames; ++i) {
    motion.setTime(i / kFps);
    renderer.updateGeometry(motion.movingParts());
    const scene::Camera camera = cameraAt(i / kFps);
    renderer::FrameOptions options{.method = renderer::Method::Virtual, .widthPx = 240, .heightPx = 180};
    const renderer::Frame frame = renderer.render(camera, options);
    options.method = renderer::Method::RayTrace;
    const renderer::Frame truth = renderer.render(camera, options);
    for (const vec4& pixel : frame.radiance.pixels())
      ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b)) << "frame " << i;
    const metrics::DisplacementResult d =
        metrics::computeDisplacement(frame.seen, truth.seen, truth.footprints);
    if (d.objectPixels.pixels >= 100) {  // else the box is behind the ball, or a 95th percentile says little
      ++withObject;
      worstP95 = std::max(worstP95, d.objectPixels.p95Px);
    }
    worstP95All = std::max(worstP95All, d.mirrorPixels.p95Px);
    worstLost = std::max(worstLost, d.mirrorPixels.shareLost);
    if (i == frames / 3) settledMegabytes = residentMegabytes();
  }
  const double growth = residentMegabytes() - settledMegabytes;
  std::printf(
      "%d frames: worst 95 %% %.3f px of mirror pixels, %.3f px of object pixels; worst lost %.2f %%; "
      "%.1f MB more than after a third of them\n",
      frames, worstP95All, worstP95, 100 * worstLost, growth);
  EXPECT_GT(withObject, frames / 3);
  EXPECT_LE(worstP95All, 0.5);  // FrameOptions::maxErrorPx
  EXPECT_LE(worstP95, 0.5);
  EXPECT_LE(worstLost, 0.01);
  EXPECT_LE(growth, 20.0);
}

TEST(MovingFrames, whatIsNotToldThatItMovedIsFoundOut) {
  MovingScene m;
  scene::WorldMotion motion(m.t.scene, m.t.world, {});
  renderer::Renderer moved(m.t.scene, m.t.world, sky()), notTold(m.t.scene, m.t.world, sky());
  const renderer::FrameOptions options{.method = renderer::Method::Virtual, .widthPx = 240, .heightPx = 180};
  const renderer::Frame before = notTold.render(cameraAt(0), options);
  motion.setTime(1.0);
  moved.updateGeometry(motion.movingParts());
  renderer::FrameOptions tracing = options;
  tracing.method = renderer::Method::RayTrace;
  const renderer::Frame truth = moved.render(cameraAt(0), tracing);
  EXPECT_GT(metrics::computeDisplacement(before.seen, truth.seen, truth.footprints).objectPixels.p95Px, 5.0);
}

}  // namespace
}  // namespace catoptric::image_test
