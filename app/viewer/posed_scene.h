// SPDX-License-Identifier: Apache-2.0
// One thread's own copy of a loaded scene, brought from state to state, and the renderer that draws it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "catoptric/renderer/frame.h"
#include "catoptric/scene/world_motion.h"
#include "loaded_scene.h"
#include "viewer/scene_state.h"

namespace catoptric::viewer {

using ScenePointer = std::shared_ptr<const app::LoadedScene>;
using GeometryPointer = std::shared_ptr<const scene::WorldGeometry>;

class PosedScene {
 public:
  PosedScene(ScenePointer base, const SceneState& state);
  PosedScene(const PosedScene&) = delete;
  PosedScene& operator=(const PosedScene&) = delete;

  struct Change {
    std::vector<std::uint32_t> movedParts;
    bool materials = false, lights = false;
    [[nodiscard]] bool isNothing() const { return movedParts.empty() && !materials && !lights; }
  };
  /// What has changed on the way; nothing where that cannot be done in place (mirrors begin or cease to be
  /// some; back to the rest pose): then the object is of no use any more, and a new one must be made.
  [[nodiscard]] std::optional<Change> bring(const SceneState& state);

  [[nodiscard]] const ScenePointer& base() const { return base_; }
  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  [[nodiscard]] const scene::WorldGeometry& geometry() const { return geometry_; }
  /// The geometry as it is now, for other threads.
  [[nodiscard]] GeometryPointer snapshot();

 private:
  void place(const SceneState& state, Change& change);

  ScenePointer base_;
  scene::Scene scene_;
  scene::WorldGeometry geometry_;
  std::unique_ptr<scene::WorldMotion> motion_;
  SceneState state_;
  GeometryPointer snapshot_;
};

/// The renderer of what was asked for last.
class KeptRenderer {
 public:
  KeptRenderer() = default;
  /// The renderer refers to the scene, so it goes first.
  ~KeptRenderer() { renderer_.reset(); }
  KeptRenderer(const KeptRenderer&) = delete;
  KeptRenderer& operator=(const KeptRenderer&) = delete;

  /// Valid until the next call. After a failure of the renderer, call drop(): a lost context stays lost.
  [[nodiscard]] renderer::Renderer& prepare(const ScenePointer& scene, const SceneState& state);
  void drop() {
    renderer_.reset();
    context_.reset();
  }
  /// Gives the memory of the scene back.
  void forget() {
    renderer_.reset();
    posed_.reset();
  }
  /// Makes the OpenGL context before there is a scene; where there is no OpenGL the first frame says so.
  void warmUp();
  [[nodiscard]] PosedScene& posed() { return *posed_; }

 private:
  std::shared_ptr<gl::Context> context_;  ///< of one renderer after the other; null: each makes its own
  std::unique_ptr<PosedScene> posed_;
  std::unique_ptr<renderer::Renderer> renderer_;
};

/// The geometry of a scene as it was loaded; shares its life.
[[nodiscard]] inline GeometryPointer geometryOf(const ScenePointer& scene) {
  return {scene, &scene->geometry};
}

}  // namespace catoptric::viewer
