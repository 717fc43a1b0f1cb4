// SPDX-License-Identifier: Apache-2.0
// What a method works with, seen from elsewhere.
#include <gtest/gtest.h>

#include "catoptric/renderer/frame.h"
#include "catoptric/scene/built_in_scenes.h"
#include "catoptric/scene/gltf_import.h"

namespace catoptric::viewer {
namespace {

struct World {
  scene::Scene scene;
  scene::WorldGeometry geometry;
  scene::Environment environment = scene::makeConstantEnvironment(vec3(0.4f));
  explicit World(const char* name)
      : scene(scene::importGltf(scene::makeBuiltInScene(name), {}, name)),
        geometry(scene::makeWorldGeometry(scene)) {}
};

using Pixels = std::vector<vec4>;

Pixels drawElsewhere(renderer::Renderer& renderer, const scene::Camera& camera,
                     const raster::MarkOptions& marks, std::uint32_t reflector = 0) {
  const core::ImageRgbaF picture = renderer.renderElsewhere(
      camera, {.reflector = reflector, .marks = marks, .widthPx = 96, .heightPx = 72});
  const auto& pixels = picture.pixels();
  for (const vec4& pixel : pixels) EXPECT_EQ(pixel.w, 1.0f) << "it would show the window behind it";
  return {pixels.begin(), pixels.end()};
}

constexpr raster::MarkOptions kNothing{
    .virtualObject = false, .tessellation = false, .cells = false, .octree = false, .zexels = false};

/// Where the eye itself stands the virtual object is the mirror's image: Q' was placed on the ray to J.
TEST(Elsewhere, FromTheEyeTheVirtualObjectIsWhatTheMirrorShows) {
  const World world("cylinder");
  renderer::Renderer renderer(world.scene, world.geometry, world.environment);
  const scene::Camera& camera = world.scene.cameras.at(0);
  const renderer::Frame frame = renderer.render(camera, {.method = renderer::Method::Virtual,
                                                         .solver = renderer::Solver::Refined,
                                                         .widthPx = 96,
                                                         .heightPx = 72});
  raster::MarkOptions marks = kNothing;
  const Pixels without = drawElsewhere(renderer, camera, marks);
  marks.virtualObject = true;
  const Pixels with = drawElsewhere(renderer, camera, marks);
  std::size_t objects = 0, shown = 0, same = 0, strays = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    const core::SeenPixel& seen = frame.seen.pixels()[i];
    const bool isObject = seen.isMirror() && seen.firstReflector == 0 && !seen.isSky() && seen.shell == 0;
    const bool isDrawn = with[i] != without[i];
    if (isObject) ++objects;
    if (isObject && isDrawn) {
      ++shown;
      // The mirror takes some of the light.
      const vec3 here(with[i]), there(frame.radiance.pixels()[i]);
      if (glm::all(glm::lessThan(glm::abs(here - there), 0.3f * here + 0.05f))) ++same;
    } else if (isDrawn && !seen.isMirror()) {
      ++strays;  // behind the mirror's edge or in front of it
    }
  }
  // Without the mirror before it, some of it is hidden by the floor behind.
  EXPECT_GT(objects, 50u);
  EXPECT_GT(double(shown), 0.6 * double(objects));
  EXPECT_GT(double(same), 0.9 * double(shown)) << "pixels of edges aside";
  EXPECT_LT(double(strays), 0.1 * double(with.size()));
}

TEST(Elsewhere, EachMethodHasItsOwnMarks) {
  const World world("cylinder");
  renderer::Renderer renderer(world.scene, world.geometry, world.environment);
  scene::Camera camera = world.scene.cameras.at(0);
  raster::MarkOptions all;
  all.tessellation = true;
  const Pixels empty = drawElsewhere(renderer, camera, all);  // before a frame there is nothing
  EXPECT_EQ(drawElsewhere(renderer, camera, kNothing), empty);
  const auto frameBy = [&](renderer::Method method) {
    (void)renderer.render(world.scene.cameras.at(0), {.method = method, .widthPx = 96, .heightPx = 72});
  };
  frameBy(renderer::Method::Virtual);
  const Pixels bare = drawElsewhere(renderer, camera, kNothing);
  for (bool raster::MarkOptions::*const choice :
       {&raster::MarkOptions::virtualObject, &raster::MarkOptions::tessellation,
        &raster::MarkOptions::cells}) {
    raster::MarkOptions marks = kNothing;
    marks.*choice = true;
    EXPECT_NE(drawElsewhere(renderer, camera, marks), bare);
  }
  raster::MarkOptions marks = kNothing;
  marks.octree = marks.zexels = true;
  EXPECT_EQ(drawElsewhere(renderer, camera, marks), bare) << "virtual objects have neither";
  frameBy(renderer::Method::Morphing);
  EXPECT_NE(drawElsewhere(renderer, camera, marks), bare) << "rays";
  frameBy(renderer::Method::Environment);
  EXPECT_EQ(drawElsewhere(renderer, camera, all), drawElsewhere(renderer, camera, kNothing));
}

TEST(Elsewhere, ZexelsLieOnTheScene) {
  const World world("checker-box");
  renderer::Renderer renderer(world.scene, world.geometry, world.environment);
  const scene::Camera& camera = world.scene.cameras.at(0);
  (void)renderer.render(camera, {.method = renderer::Method::Zexel, .widthPx = 96, .heightPx = 72});
  raster::MarkOptions marks = kNothing;
  const Pixels bare = drawElsewhere(renderer, camera, marks);
  marks.zexels = true;
  EXPECT_NE(drawElsewhere(renderer, camera, marks), bare);
}

}  // namespace
}  // namespace catoptric::viewer
