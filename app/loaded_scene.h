// SPDX-License-Identifier: Apache-2.0
// From what the command line says to what a Renderer needs.
#pragma once

#include <memory>
#include <string>

#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/scene/world_motion.h"
#include "shared_options.h"

namespace catoptric::app {

/// A scene and all that is made from it. Renderers keep references to its members: it stays where it is.
struct LoadedScene {
  LoadedScene() = default;
  LoadedScene(const LoadedScene&) = delete;
  LoadedScene& operator=(const LoadedScene&) = delete;

  std::string source;  ///< as given on the command line
  std::string name;    ///< file name without extension, or the built-in scene's name
  bool isBuiltIn = false;
  scene::Scene scene;
  scene::WorldGeometry geometry;
  scene::ReflectorOptions reflectorOptions;    ///< that the geometry was made with
  std::string animation;                       ///< --animation
  std::unique_ptr<scene::WorldMotion> motion;  ///< null in the rest pose
  scene::Environment environment;              ///< empty until loadEnvironment()
};

/// `source`: a file, "-" for a .glb on stdin, or a built-in scene's name; a file wins. Says the scene's
/// warnings.
[[nodiscard]] std::unique_ptr<LoadedScene> loadScene(const std::string& source, const SceneOptions& options);

/// Throws for --time and --animation of a scene that has none.
void checkMotion(const LoadedScene& loaded, const SceneOptions& options);

/// Throws if there is no such file or built-in scene; for commands that take several scenes and long for
/// each.
void checkSource(const std::string& source);

/// The built-in sky where no file is named. Throws core::Error.
[[nodiscard]] scene::Environment makeEnvironmentFrom(const std::string& file);

void loadEnvironment(LoadedScene& loaded, const std::string& file);

/// Throws UsageError for options that contradict each other, core::Error for a camera that is not there.
[[nodiscard]] scene::Camera chooseCamera(const LoadedScene& loaded, const CameraOptions& options);

}  // namespace catoptric::app
