// SPDX-License-Identifier: Apache-2.0
// All that it takes to come back to what the viewer shows. Its file is JSON (session_file.h).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "viewer/model.h"

namespace catoptric::viewer {

struct Session {
  LoadRequest scene;                      ///< with its surroundings and mirrors
  std::vector<std::string> sceneOptions;  ///< of the command line, that change how the scene is read
  std::string animation;                  ///< --animation
  scene::Camera camera;
  std::optional<std::size_t> sceneCamera;
  renderer::FrameOptions frame;  ///< with method and solver; its size is the window's
  float exposure = 1, resolution = 1, split = 0.5f;
  Comparison comparison = Comparison::None;
  SceneState state;
  bool isPlaying = false;
  /// Names of what was edited, to tell whether the scene is still the same.
  std::map<std::uint32_t, std::string> objectNames, materialNames;
};

/// Throws core::Error("session.scene") if what the session edits is not in the scene.
void checkSession(const Session& session, const scene::Scene& scene);

[[nodiscard]] Session makeSession(const Model& model, const ivec2& windowPx);

/// All but the scene, which has been loaded.
void restoreSession(const Session& session, ViewState& view);

}  // namespace catoptric::viewer
