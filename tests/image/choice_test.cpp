// SPDX-License-Identifier: Apache-2.0
// What `auto` expects of a way of drawing a mirror, and what it picks, against what is drawn and the truth.
#include <gtest/gtest.h>

#include <algorithm>

#include "catoptric/environment_map/map_view.h"
#include "catoptric/geometry/nearest_hit.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/metrics/displacement.h"
#include "catoptric/renderer/choose_method.h"
#include "catoptric/renderer/expected_error.h"
#include "catoptric/scene/built_in_scenes.h"
#include "catoptric/scene/gltf_import.h"
#include "catoptric/scene/hierarchy_triangles.h"
#include "image_test_support.h"
#include "traced_scene.h"

namespace catoptric::image_test {
namespace {

using renderer::Method;
using renderer::MethodCandidate;
using renderer::MethodChoice;
using renderer::Solver;

static_assert(renderer::kLostPx == double(metrics::kLostPx));

/// A scene as a camera sees it in a small picture.
struct Room {
  Room(scene::Scene shown, const scene::Camera& from)
      : scene(std::move(shown)),
        camera(from),
        world(scene::makeWorldGeometry(scene)),
        triangles(scene::listTriangles(world)),
        renderer(scene, world, sky()) {}
  explicit Room(const std::string& name) : Room(scene::importGltf(scene::makeBuiltInScene(name), {}, name)) {}
  explicit Room(const scene::Scene& shown) : Room(shown, shown.cameras.front()) {}

  [[nodiscard]] scene::CameraFrame view() const { return scene::makeCameraFrame(camera, kWidth, kHeight); }
  [[nodiscard]] MethodChoice choose(std::uint32_t reflector, double maxErrorPx) const {
    renderer::MethodChooser chooser(world, triangles);
    return chooser.choose(reflector, view(), {.maxErrorPx = maxErrorPx});
  }
  [[nodiscard]] renderer::Frame render(Method method, double maxErrorPx) {
    return renderer.render(
        camera, {.method = method, .widthPx = kWidth, .heightPx = kHeight, .maxErrorPx = maxErrorPx});
  }
  /// 95th percentile of the displacement, of mirror pixels or of object pixels: the worse.
  [[nodiscard]] static double measure(const renderer::Frame& frame, const renderer::Frame& truth) {
    const auto result = metrics::computeDisplacement(frame.seen, truth.seen, truth.footprints);
    return std::max(result.mirrorPixels.p95Px, result.objectPixels.p95Px);
  }
  static constexpr int kWidth = 240, kHeight = 180;
  scene::Scene scene;
  scene::Camera camera;
  scene::WorldGeometry world;
  geometry::TriangleHierarchy triangles;
  renderer::Renderer renderer;
};

/// A small ball with boxes around it, eighty radii away.
Room makeFarRoom() {
  reference::TracedTestScene t;
  t.camera.eye = {0, 0.1, 0.6};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.3;
  scene::Material paint;
  paint.metallic = 0;
  t.add(reference::makeBall(96, 48), reference::makeMirror(), "ball", geometry::scaleBy(dvec3(0.05)));
  const geometry::Mesh mesh = geometry::makeBox({1, 1, 1});
  scene::MeshPrimitive box;
  box.positions = mesh.positions, box.normals = mesh.normals, box.indices = mesh.indices;
  for (int i = 0; i < 8; ++i)
    t.add(box, paint, "box",
          geometry::turnAround({0, 1, 0}, 0.25 * reference::kPi * (i + 0.5)) *
              geometry::moveBy({0, i % 3 - 1, 4}));
  t.finish();
  return {t.scene, t.camera};
}

bool usesMap(const MethodChoice& choice) {
  return choice.method == Method::Environment;
}

TEST(Choice, isTheMapWhereTheBoundAllowsIt) {
  Room room = makeFarRoom();
  const renderer::Frame truth = room.render(Method::RayTrace, 1);
  constexpr double kLoose = 4, kTight = 0.1;
  EXPECT_TRUE(usesMap(room.choose(0, kLoose)));
  EXPECT_FALSE(usesMap(room.choose(0, kTight)));
  const renderer::Frame loose = room.render(Method::Auto, kLoose), tight = room.render(Method::Auto, kTight);
  EXPECT_EQ(loose.counters.virtualVertices + loose.counters.fragmentTests, 0u);
  EXPECT_GT(tight.counters.virtualVertices + tight.counters.fragmentTests, 0u);
  EXPECT_LE(Room::measure(loose, truth), kLoose);
  EXPECT_GT(Room::measure(loose, truth), kTight);  // the bound has something to decide
  EXPECT_LE(Room::measure(tight, truth), kTight);
  const double expected = room.choose(0, kLoose).candidates.front().errorPx;
  EXPECT_GT(expected, Room::measure(loose, truth) / 2);
  EXPECT_LT(expected, Room::measure(loose, truth) * 2);
  // Once something has moved a map would be out of date in every frame.
  room.renderer.updateGeometry({});
  EXPECT_GT(room.render(Method::Auto, kLoose).counters.virtualVertices, 0u);
}

/// A ball on a table among things: a map loses what is near, whatever is allowed.
TEST(Choice, keepsTheBoundWhereMapsAreWrong) {
  Room room("four-spheres");
  const renderer::Frame truth = room.render(Method::RayTrace, 1);
  for (const double bound : {0.5, 10.0}) {
    EXPECT_FALSE(usesMap(room.choose(0, bound)));
    EXPECT_LE(Room::measure(room.render(Method::Auto, bound), truth), bound);
  }
  EXPECT_GT(Room::measure(room.render(Method::Environment, 10), truth), 10);
}

TEST(Choice, isExactWhereAMirrorIsNotConvex) {
  Room room("mixed");
  const MethodChoice choice = room.choose(0, 0.5);
  EXPECT_EQ(choice.method, Method::Virtual);
  const renderer::Frame truth = room.render(Method::RayTrace, 1);
  EXPECT_LE(Room::measure(room.render(Method::Auto, 0.5), truth), 0.5);
  const auto pixels = std::count_if(truth.seen.pixels().begin(), truth.seen.pixels().end(),
                                    [](const core::SeenPixel& p) { return p.isMirror(); });
  EXPECT_NEAR(choice.forecast->pixels, double(pixels), 0.03 * double(pixels));
}

/// What nothing has moved in keeps its way of drawing until that is past the bound or clearly too dear.
TEST(Choice, doesNotFlicker) {
  const std::vector<MethodCandidate> ways{{Method::Environment, Solver::Auto, 0.45, false, 3},
                                          {Method::Virtual, Solver::Refined, 0.02, false, 30},
                                          {Method::Virtual, Solver::Exact, 0, false, 28}};
  const auto pick = [&](double bound, const MethodCandidate* last) {
    MethodChoice before;
    if (last) before.method = last->method, before.solver = last->solver;
    return renderer::pickCandidate(ways, bound, last ? &before : nullptr);
  };
  EXPECT_EQ(pick(0.5, nullptr), 0u);
  EXPECT_EQ(pick(0.5, &ways[1]), 1u);  // the map is within the bound, but not by a margin
  EXPECT_EQ(pick(0.6, &ways[1]), 0u);
  EXPECT_EQ(pick(0.46, &ways[0]), 0u);
  EXPECT_EQ(pick(0.4, &ways[0]), 2u);  // past the bound: the cheapest of the others
  EXPECT_EQ(pick(0.4, &ways[1]), 1u);  // hardly dearer
  EXPECT_EQ(pick(0.4, nullptr), 2u);
}

/// What was picked for a frame at rest serves while frames pass; before there was one, the shape decides.
TEST(Choice, isNotAskedAboutWhileFramesPass) {
  Room room = makeFarRoom();
  const auto render = [&](double maxErrorPx, bool isPassing) {
    const renderer::Frame frame = room.renderer.render(room.camera, {.method = Method::Auto,
                                                                     .widthPx = Room::kWidth,
                                                                     .heightPx = Room::kHeight,
                                                                     .maxErrorPx = maxErrorPx,
                                                                     .isPassing = isPassing});
    return frame.counters.virtualVertices + frame.counters.fragmentTests;
  };
  EXPECT_GT(render(20, true), 0u);
  EXPECT_EQ(render(20, false), 0u);  // a map
  EXPECT_EQ(render(0.01, true), 0u);
  EXPECT_GT(render(0.01, false), 0u);
}

/// MapView says what a map shows, and environment_map.frag shows it.
TEST(Choice, knowsWhatAMapShows) {
  Room room("columns");
  const renderer::Frame frame = room.render(Method::Environment, 1);
  const scene::CameraFrame camera = room.view();
  const auto curved = std::find_if(room.world.reflectors.begin(), room.world.reflectors.end(),
                                   [](const scene::Reflector& r) { return !r.isPlanarMirror(); });
  const auto index = std::uint32_t(curved - room.world.reflectors.begin());
  const environment_map::MapView map(room.world, room.triangles, index, true);
  int asked = 0, agree = 0;
  for (int y = 0; y < 180; y += 3)
    for (int x = 0; x < 240; x += 3) {
      const core::SeenPixel& seen = frame.seen.at(x, y);
      if (seen.firstReflector != index || seen.isSky()) continue;
      const dvec3 direction = glm::normalize(camera.rayDirection(x + 0.5, y + 0.5));
      const auto hit = geometry::findNearestHit(room.triangles, camera.eye, direction);
      if (!hit) continue;
      const dvec3 j = camera.eye + hit->distance * direction;
      const auto normal = glm::normalize(j - curved->centre);  // a ball
      const auto shown = map.look(j, core::reflectDirection(direction, normal));
      ++asked;
      agree += glm::length(shown.point - dvec3(seen.point)) < 0.02 * shown.distance;  // a few texels of 512
    }
  EXPECT_GT(asked, 500);
  EXPECT_GT(agree, 0.97 * asked);
}

}  // namespace
}  // namespace catoptric::image_test
