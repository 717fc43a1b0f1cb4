// SPDX-License-Identifier: Apache-2.0
// Edits of the viewer's scene: undo, what the mouse takes hold of, and that a state looks the same by
// whatever way it was reached.
#include <gtest/gtest.h>

#include "catoptric/scene/built_in_scenes.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/gltf_import.h"
#include "viewer/dragging.h"
#include "viewer/posed_scene.h"

namespace catoptric::viewer {
namespace {

/// Made once: its textures take a second.
std::shared_ptr<app::LoadedScene> makeLoaded() {
  static std::shared_ptr<app::LoadedScene> loaded;
  if (loaded) return loaded;
  loaded = std::make_shared<app::LoadedScene>();
  loaded->scene = scene::importGltf(scene::makeBuiltInScene("checker-box"), {}, "checker-box");
  loaded->geometry = scene::makeWorldGeometry(loaded->scene);
  loaded->environment = scene::makeConstantEnvironment(vec3(0.4f));
  return loaded;
}

/// The first instance that has triangles and is no mirror, or is one.
std::uint32_t findInstance(const scene::WorldGeometry& world, bool isMirror) {
  for (const scene::Part& part : world.parts)
    if (!part.shell && (part.reflector != core::kNoId) == isMirror) return part.object;
  ADD_FAILURE() << "no such instance";
  return 0;
}

TEST(EditHistory, UndoesAndRedoesInOrder) {
  SceneState state;
  const std::vector<scene::Material> materials(2);
  EditHistory history;
  history.add(ShiftEdit{1, dvec3(0), dvec3(0)});  // a click that moved nothing
  EXPECT_FALSE(history.canUndo());
  state.setShift(1, dvec3(1, 0, 0));
  history.add(ShiftEdit{1, dvec3(0), dvec3(1, 0, 0)});
  scene::MaterialValues rough = scene::readMaterialValues(materials[0]);
  rough.roughness = 0.25f;
  history.add(MaterialEdit{0, scene::readMaterialValues(materials[0]), rough});
  state.setValues(0, materials[0], rough);
  const SceneState edited = state;
  EXPECT_TRUE(history.undo(state, materials));
  EXPECT_TRUE(state.materials.empty());
  EXPECT_TRUE(history.undo(state, materials));
  EXPECT_FALSE(state.hasEdits());
  EXPECT_FALSE(history.undo(state, materials));
  while (history.redo(state, materials)) {
  }
  EXPECT_EQ(state, edited);
  EXPECT_TRUE(history.undo(state, materials));
  history.add(ShiftEdit{1, dvec3(1, 0, 0), dvec3(2, 0, 0)});
  EXPECT_FALSE(history.canRedo()) << "a new edit ends what was undone";
}

TEST(Dragging, WhatIsTakenStaysUnderTheMouse) {
  scene::Camera camera;
  camera.eye = dvec3(1, 2, 5);
  camera.target = dvec3(0, 0.5, 0);
  const int widthPx = 320, heightPx = 240;
  const scene::CameraFrame frame = scene::makeCameraFrame(camera, widthPx, heightPx);
  const dvec2 fromPx(80, 200), movePx(33, -57);
  const dvec3 point = frame.eye + 3.0 * frame.rayDirection(fromPx.x, fromPx.y);
  const dvec3 moved = point + findDrag(camera, point, movePx, heightPx);
  const dvec3 wanted = frame.eye + 3.0 * frame.rayDirection(fromPx.x + movePx.x, fromPx.y + movePx.y);
  EXPECT_LT(glm::length(moved - wanted), 1e-9);
}

TEST(Dragging, TakesTheNearestObjectAndNothingFromTheSky) {
  const auto loaded = makeLoaded();
  const std::uint32_t object = findInstance(loaded->geometry, true);
  core::Box box;
  for (const scene::Part& part : loaded->geometry.parts)
    if (part.object == object)
      for (std::uint32_t v = 0; v < part.vertexCount; ++v)
        box.add(dvec3(loaded->geometry.positions[part.firstVertex + v]));
  const scene::Reflector& mirror = loaded->geometry.reflectors.at(0);
  ASSERT_EQ(mirror.object, object);
  scene::Camera camera;
  camera.target = mirror.centre;
  camera.eye = mirror.centre + 0.05 * mirror.radius * mirror.plane.normal;
  const auto grabbed = findObjectAt(loaded->geometry, camera, dvec2(0.5), 1.5);
  ASSERT_TRUE(grabbed);
  EXPECT_EQ(grabbed->instance, object);
  EXPECT_LT(glm::length(grabbed->point - mirror.centre), 1e-3 * mirror.radius);
  camera.eye = loaded->geometry.bounds.upper + dvec3(1, 1, 1);
  camera.target = camera.eye + dvec3(1, 1, 1);
  EXPECT_FALSE(findObjectAt(loaded->geometry, camera, dvec2(0.5), 1.5));
}

TEST(PosedScene, ShiftedThereAndBackIsAsLoaded) {
  const auto loaded = makeLoaded();
  PosedScene posed(loaded, {});
  EXPECT_EQ(posed.snapshot().get(), &loaded->geometry) << "nothing is copied of what is as loaded";
  SceneState state;
  state.setShift(findInstance(loaded->geometry, true), dvec3(0.5, 0, 0.25));
  const auto there = posed.bring(state);
  ASSERT_TRUE(there);
  EXPECT_FALSE(there->movedParts.empty());
  const auto moved = posed.snapshot();
  EXPECT_NE(moved->reflectors[0].centre, loaded->geometry.reflectors[0].centre);
  const auto back = posed.bring({});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->movedParts, there->movedParts);
  EXPECT_EQ(posed.geometry().positions, loaded->geometry.positions);
  EXPECT_EQ(posed.geometry().reflectors[0].centre, loaded->geometry.reflectors[0].centre);
  EXPECT_NE(moved->positions, loaded->geometry.positions) << "a snapshot does not change any more";
}

/// However a state was reached, its picture is the same.
TEST(KeptRenderer, AnEditedSceneLooksAsOneThatWasMadeSo) {
  const auto loaded = makeLoaded();
  scene::Camera camera = scene::makeFrameAllCamera(loaded->geometry.bounds);
  if (!loaded->scene.cameras.empty()) camera = loaded->scene.cameras.front();
  SceneState state;
  state.setShift(findInstance(loaded->geometry, false), dvec3(0.1, 0.05, 0));
  const int mirror = loaded->geometry.reflectors.at(0).material;
  scene::MaterialValues values = scene::readMaterialValues(loaded->scene.materials[std::size_t(mirror)]);
  values.tint = vec3(0.3f, 0.9f, 0.4f);
  values.reflectivity = 0.6f;
  state.materials[mirror] = values;
  SceneState rough = state;
  rough.materials[mirror].roughness = 0.5f;  // no mirror any more
  for (const renderer::Method method :
       {renderer::Method::Virtual, renderer::Method::Zexel, renderer::Method::RayTrace}) {
    const renderer::FrameOptions options{.method = method, .widthPx = 64, .heightPx = 48};
    const auto draw = [&](KeptRenderer& kept, const SceneState& wanted) {
      return kept.prepare(loaded, wanted).render(camera, options).radiance.pixels();
    };
    KeptRenderer kept;
    const auto before = draw(kept, {}), edited = draw(kept, state), roughened = draw(kept, rough),
               again = draw(kept, state), undone = draw(kept, {});
    KeptRenderer fresh;
    EXPECT_EQ(draw(fresh, state), edited) << renderer::methodName(method);
    EXPECT_EQ(again, edited);
    EXPECT_NE(edited, before);
    EXPECT_NE(roughened, edited);
    EXPECT_EQ(undone, before);
  }
}

}  // namespace
}  // namespace catoptric::viewer
