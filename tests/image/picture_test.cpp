// SPDX-License-Identifier: Apache-2.0
// Raster pictures against ray-traced ones, 256x256, through the library. Each test has its twin: the raster
// method works on a normal or plane that is turned by a few tenths of a degree, the truth on the right one,
// and the same limits must refuse it. Limits are about twice what was measured (printed by each test).
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>

#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "catoptric/geometry/sampled_surface.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/scene/built_in_scenes.h"
#include "catoptric/scene/gltf_import.h"
#include "image_test_support.h"
#include "traced_scene.h"

namespace catoptric::image_test {
namespace {

using reference::makeMirror;
using reference::makeQuad;
using reference::TracedTestScene;

struct LoadedScene {
  scene::Scene scene;
  scene::WorldGeometry world;
};

const LoadedScene& builtIn(const std::string& name) {
  static std::map<std::string, std::unique_ptr<LoadedScene>> cache;
  std::unique_ptr<LoadedScene>& entry = cache[name];
  if (!entry) {
    entry = std::make_unique<LoadedScene>();
    entry->scene = scene::importGltf(scene::makeBuiltInScene(name), {}, name);
    entry->world = scene::makeWorldGeometry(entry->scene);
  }
  return *entry;
}

Subject subjectOf(const std::string& name, int bounces = 1) {
  const LoadedScene& loaded = builtIn(name);
  return {name, loaded.scene, loaded.world, loaded.scene.cameras.front(), bounces};
}

/// A ball and a flat mirror that show each other, with a lit board between them.
struct BallAndMirror {
  TracedTestScene t;
  BallAndMirror() {
    t.camera.eye = {1.2, 1.3, 3.4};
    t.camera.target = {0, 0.6, 0};
    t.camera.fovYRadians = 0.75;
    scene::Material paint;
    paint.metallic = 0;
    paint.baseColor = {0.9f, 0.45f, 0.2f, 1};
    scene::Material floor = paint;
    floor.baseColor = {0.5f, 0.55f, 0.6f, 1};
    t.add(reference::makeBall(96, 48), makeMirror(vec3(0.95f)), "ball",
          geometry::moveBy({-0.5, 0.6, 0.4}) * geometry::scaleBy(dvec3(0.6)));
    t.add(makeQuad({-1.6f, 0, -0.7f}, {3.2f, 0, 0}, {0, 1.9f, 0}), makeMirror(), "flat");
    t.add(makeQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), floor, "floor");
    scene::MeshPrimitive box;
    const geometry::Mesh mesh = geometry::makeBox({0.35, 0.5, 0.35});
    box.positions = mesh.positions, box.normals = mesh.normals, box.indices = mesh.indices;
    t.add(box, paint, "box", geometry::moveBy({0.6, 0.25, 0.3}) * geometry::turnAround({0, 1, 0}, 0.5));
    t.finish();
  }
  [[nodiscard]] Subject subject(const char* name) const { return {name, t.scene, t.world, t.camera, 2}; }
};

void addCurvedMirror(TracedTestScene& t, const geometry::Mesh& mesh) {
  scene::MeshPrimitive curved;
  curved.positions = mesh.positions, curved.normals = mesh.normals, curved.indices = mesh.indices;
  t.add(curved, makeMirror(vec3(0.95f)), "curved");
}

TEST(Picture, sceneWithoutMirrors) {
  const Subject subject = subjectOf("four-spheres");
  scene::Scene plain = subject.scene;
  for (scene::Material& material : plain.materials) material.hint.reflector = false;
  const scene::WorldGeometry world = scene::makeWorldGeometry(plain);
  ASSERT_TRUE(world.reflectors.empty());
  scene::WorldGeometry twin = world;
  const dmat3 turn(glm::rotate(dmat4(1.0), 0.01, dvec3(1, 0, 0)));
  for (vec3& normal : twin.normals) normal = vec3(turn * dvec3(normal));
  expectWithin(
      {"no-mirrors", plain, world, subject.camera}, twin,
      {2, 0.15, "the same formulas on the same floats; a GPU filters textures with weights of 8 bits"});
}

TEST(Picture, planarMirror) {
  const Subject subject = subjectOf("checker-box");
  expectWithin(
      subject, withTurnedPlanes(subject.world, 0.005),
      {8, 0.25, "flat mirrors are exact: rounding, and edges that fall to the other side of a pixel"});
}

TEST(Picture, mirrorsInMirrors) {
  const Subject subject = subjectOf("hall-of-mirrors", 3);
  expectWithin(
      subject, withTurnedPlanes(subject.world, 0.005),
      {8, 0.25, "flat mirrors are exact: rounding, and edges that fall to the other side of a pixel"});
}

TEST(Picture, curvedInFlat) {
  const BallAndMirror scene;
  const Subject subject = scene.subject("curved-in-flat");
  expectWithin(subject, withTurnedPlanes(subject.world, 0.005),
               {12, 0.1, "the ball's rim, where the whole sky is squeezed into one pixel"});
}

TEST(Picture, flatInCurved) {
  const BallAndMirror scene;
  Subject subject = scene.subject("flat-in-curved");
  subject.camera.eye = {0.3, 0.9,
                        3.0};  // near the ball, which shows the flat mirror's edge and the box twice
  subject.camera.target = {-0.5, 0.6, 0.4};
  subject.camera.fovYRadians = 0.5;
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {10, 0.12, "the ball's rim, where the whole sky is squeezed into one pixel"});
}

TEST(Picture, flatBehindCurvedShowsWhatLiesBehindIt) {
  // A slightly curved mirror before a wall; a flat one opposite, above the eye, lets it show that wall.
  TracedTestScene t;
  t.camera.eye = {0, -0.1, 1.6};
  t.camera.target = {0, 0.05, 0};
  t.camera.fovYRadians = 0.6;
  const geometry::Mesh mesh = geometry::makeHeightField(
      24, 24, [](dvec2 at) { return 0.45 * at; },
      [](dvec2 at) {
        return geometry::HeightSample{-0.06 * glm::dot(at, at), -0.12 * at.x, -0.12 * at.y};
      });
  addCurvedMirror(t, mesh);
  t.add(makeQuad({2, 0.3f, 2.4f}, {-4, 0, 0}, {0, 2.4f, 0}), makeMirror(), "flat");
  t.add(makeQuad({-3, -2, -0.7f}, {6, 0, 0}, {0, 7, 0}), reference::makeUnlit(vec3(0.8f, 0.2f, 0.1f)),
        "wall");
  t.add(makeQuad({-0.3f, 2.2f, -0.6f}, {0.6f, 0, 0}, {0, 0.6f, 0}),
        reference::makeUnlit(vec3(0.1f, 0.8f, 0.2f)), "sign");
  t.finish();
  const Subject subject{"behind-curved", t.scene, t.world, t.camera, 2};
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {10, 0.12, "edges that fall to the other side of a pixel"});
}

TEST(Picture, fourSpheres) {
  const Subject subject = subjectOf("four-spheres");
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {22, 0.6, "rims, where the whole room is squeezed into one pixel"});
}

TEST(Picture, fender) {
  const Subject subject = subjectOf("fender");
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {22, 0.4, "thin bright poles, up to a tenth of a pixel beside their place"});
}

TEST(Picture, cylinder) {
  const Subject subject = subjectOf("cylinder");
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {10, 0.25, "reflection points are interpolated between vertices"});
}

/// A television's frame reaches behind its screen: in the corners of what the screen shows, a triangle of the
/// frame has hidden corners and others past the mirror's boundary, none that is reflected.
TEST(Picture, convexMirrorInAFrame) {
  TracedTestScene t;
  t.camera.eye = {0.2, 0.2, 2.25};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.5;
  const geometry::Mesh mesh = geometry::makeHeightField(
      80, 16, [](dvec2 at) { return dvec2(0.46, 0.34) * at; },
      [](dvec2 at) {
        const double squared = at.x * at.x;
        return geometry::HeightSample{-0.35 * squared - 0.9 * squared * squared,
                                      -0.7 * at.x - 3.6 * squared * at.x, 0};
      });
  addCurvedMirror(t, mesh);
  const auto addSide = [&](const vec2& corner, const vec3& along, const vec3& colour) {
    t.add(makeQuad(vec3(corner, -0.205f), {0, 0, 0.15f}, along), reference::makeUnlit(colour), "side");
  };
  addSide({-0.462f, 0.342f}, {0, -0.684f, 0}, vec3(0.8f, 0.2f, 0.1f));
  addSide({0.462f, -0.342f}, {0, 0.684f, 0}, vec3(0.1f, 0.2f, 0.8f));
  addSide({0.462f, 0.342f}, {-0.924f, 0, 0}, vec3(0.1f, 0.7f, 0.2f));
  addSide({-0.462f, -0.342f}, {0.924f, 0, 0}, vec3(0.7f, 0.7f, 0.1f));
  t.finish();
  Subject subject{"in-a-frame", t.scene, t.world, t.camera, 1};
  subject.solver = renderer::Solver::Refined;
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {12, 0.05, "edges that fall to the other side of a pixel"});
}

/// In a small mirror virtual triangles are few and sag: a board 15 mm before a wall 4 m away must hide it.
TEST(Picture, aBoardCloseToAWallInASmallMirror) {
  TracedTestScene t;
  t.camera.eye = {0.3, 0.25, 2.2};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.9;
  const geometry::Mesh mesh = geometry::makeHeightField(
      32, 32, [](dvec2 at) { return 0.4 * at; },
      [](dvec2 at) {
        return geometry::HeightSample{-0.5 * glm::dot(at, at), -at.x, -at.y};
      });
  addCurvedMirror(t, mesh);
  t.add(makeQuad({3, -1.2f, 4}, {-6, 0, 0}, {0, 3, 0}), reference::makeUnlit(vec3(0.8f, 0.7f, 0.6f)), "wall");
  t.add(makeQuad({2.5f, -0.7f, 3.985f}, {-5, 0, 0}, {0, 1.2f, 0}),
        reference::makeUnlit(vec3(0.1f, 0.2f, 0.7f)), "board");
  t.finish();
  Subject subject{"board-and-wall", t.scene, t.world, t.camera, 1};
  subject.solver = renderer::Solver::Refined;
  expectWithin(subject, withTurnedNormals(subject.world, 0.01),
               {12, 0.05, "edges that fall to the other side of a pixel"});
}

TEST(Picture, concaveMirror) {
  const Subject subject = subjectOf("concave-bowl");
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {8, 0.15, "solver exact: rounding, and edges that fall to the other side of a pixel"});
}

TEST(Picture, mirrorOfMixedCurvature) {
  const Subject subject = subjectOf("mask");
  expectWithin(subject, withTurnedNormals(subject.world, 0.005),
               {8, 0.15, "solver exact: rounding, and edges that fall to the other side of a pixel"});
}

TEST(Picture, virtualObjectsInParts) {
  Subject subject = subjectOf("wavy-wall");  // crests by virtual objects, troughs by solver exact
  subject.solver = renderer::Solver::Refined;
  subject.allParts = true;
  expectWithin(
      subject, withTurnedNormals(subject.world, 0.005),
      {22, 0.2, "thin poles and the frame at the mirror's edge, a tenth of a pixel beside their place"});
}

TEST(Picture, refraction) {
  const Subject subject = subjectOf("lenses");
  expectWithin(
      subject, withTurnedNormals(subject.world, 0.005),
      {24, 0.25, "solver exact: rounding, and rims, where the whole room is squeezed into one pixel"});
}

/// A mirror that the eye sees a few pixels of: an environment map by `auto`, as long as nothing moves.
TEST(Picture, mirrorsOfAFewPixels) {
  BallAndMirror b;
  b.t.camera.eye = {6, 5, 90};
  b.t.camera.target = {-0.5, 0.6, 0.4};
  renderer::Renderer renderer(b.t.scene, b.t.world, sky());
  const renderer::FrameOptions options{.widthPx = 128, .heightPx = 128};
  const auto drawsVirtualObjects = [&] {
    const renderer::Frame frame = renderer.render(b.t.camera, options);
    return frame.counters.virtualVertices + frame.counters.fragmentTests > 0;
  };
  EXPECT_FALSE(drawsVirtualObjects());
  b.t.camera.eye = {2, 1.7, 12};
  EXPECT_TRUE(drawsVirtualObjects());  // near enough
  b.t.camera.eye = {6, 5, 90};
  renderer.updateGeometry({});
  EXPECT_TRUE(drawsVirtualObjects());  // a map would have to be made anew in every frame
}

/// Glass in a room of mirrors: at the limit of bounces a mirror is followed nowhere and shows the
/// environment, directly, behind glass and beside it.
TEST(Picture, mirrorsThatNothingFollowsBesideGlass) {
  scene::Scene room = builtIn("lenses").scene;
  int mirrors = 0;
  for (scene::Material& material : room.materials)
    if (material.name.find("plaster") != std::string::npos ||
        material.name.find("wood") != std::string::npos) {
      material.metallic = 1, material.roughness = 0;
      ++mirrors;
    }
  ASSERT_GT(mirrors, 0);
  const scene::WorldGeometry world = scene::makeWorldGeometry(room);
  const Subject subject{"mirrors-beside-glass", room, world, room.cameras.front(), 0};
  expectWithin(
      subject, withTurnedNormals(world, 0.005),
      {24, 0.25, "solver exact: rounding, and rims, where the whole room is squeezed into one pixel"});
}

// A frame that need not say what is seen stores less, and composes without ids.
TEST(Picture, isTheSameWhetherItSaysWhatIsSeen) {
  for (const char* name : {"polyhedra-and-sphere", "lenses", "mixed"})
    for (const int bounces : {1, 2}) {
      const LoadedScene& subject = builtIn(name);
      renderer::Renderer renderer(subject.scene, subject.world, sky());
      renderer::FrameOptions options{.widthPx = 120, .heightPx = 90, .bounces = bounces};
      const core::ImageRgbaF said = renderer.render(subject.scene.cameras.front(), options).radiance;
      options.withSeen = false;
      const core::ImageRgbaF unsaid = renderer.render(subject.scene.cameras.front(), options).radiance;
      EXPECT_TRUE(std::ranges::equal(said.pixels(), unsaid.pixels())) << name << ", " << bounces;
    }
}

// A baseline where the truth cannot judge: both renderers share their shading, sky and tone mapping, so a
// change there changes both alike. CATOPTRIC_WRITE_BASELINES=1 writes it anew; look at it before it is kept.
TEST(Picture, shadingIsAsItWas) {
  TracedTestScene t;
  t.camera.eye = {0, 0.4, 9};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.6;
  scene::Light lamp;
  lamp.position = {-3, 4, 5};
  lamp.color = vec3(60, 50, 40);
  t.scene.lights.push_back(lamp);
  const auto addBalls = [&](bool isTwin) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        scene::Material material;
        material.metallic = 0.5f * float(row);
        material.roughness = 0.15f + 0.4f * float(column) + (isTwin ? 0.03f : 0.0f);
        material.baseColor = {0.9f, 0.5f, 0.2f, 1};
        t.add(reference::makeBall(48, 24), material, "ball",
              geometry::moveBy({1.7 * (column - 1), 1.7 * (row - 1), 0}) * geometry::scaleBy(dvec3(0.75)));
      }
    t.finish();
    return draw({"shading", t.scene, t.world, t.camera}, t.world, renderer::Method::RayTrace, 128);
  };
  const Limits limits{2, 0.3, "compilers may round differently by one step of 8 bits"};
  const core::ImageRgba8 actual = addBalls(false);
  t.scene.meshes.clear(), t.scene.instances.clear(), t.scene.materials.clear();
  const core::ImageRgba8 twin = addBalls(true);
  const std::string file = CATOPTRIC_SOURCE_DIR "/tests/image/baselines/shading.png";
  if (std::getenv("CATOPTRIC_WRITE_BASELINES") != nullptr)
    core::writeFileAtomically(file, std::span<const std::byte>(core::encodePng(actual)));
  const core::ImageRgba8 baseline = core::decodeImage(core::readFile(file), file);
  EXPECT_TRUE(isWithin("shading", actual, baseline, limits));
  EXPECT_FALSE(isWithin("shading, twin", twin, baseline, limits));
  if (HasFailure()) writeFailure("shading", actual, baseline);
}

}  // namespace
}  // namespace catoptric::image_test
