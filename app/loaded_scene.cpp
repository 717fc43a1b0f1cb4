// SPDX-License-Identifier: Apache-2.0
#include "loaded_scene.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "catoptric/core/error.h"
#include "catoptric/scene/built_in_scenes.h"
#include "suggest.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

constexpr std::size_t kWarningsShown = 8;

std::vector<std::byte> readStandardInput(std::size_t maxBytes) {
  std::vector<std::byte> bytes;
  char buffer[1 << 16];
  while (std::cin.read(buffer, sizeof buffer) || std::cin.gcount() > 0) {
    const auto* begin = reinterpret_cast<const std::byte*>(buffer);
    bytes.insert(bytes.end(), begin, begin + std::cin.gcount());
    if (bytes.size() > maxBytes)
      throw core::Error("file.too_large", fmt::format("standard input is larger than {} bytes", maxBytes));
  }
  return bytes;
}

std::vector<std::string> builtInNames() {
  std::vector<std::string> names;
  for (const scene::BuiltInScene& builtIn : scene::builtInScenes()) names.emplace_back(builtIn.name);
  return names;
}

bool isBuiltInName(const std::string& name) {
  for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
    if (builtIn.name == name) return true;
  return false;
}

/// A file that is not there may be a slip in a built-in scene's name.
[[noreturn]] void throwNotFound(const std::string& source) {
  throw core::Error("file.not_found",
                    "cannot open '" + source + "': no such file, and no built-in scene either", {},
                    makeSuggestion(source, builtInNames(), "'catoptric scenes' lists the built-in ones"));
}

void importInto(LoadedScene& loaded, const scene::ImportOptions& options) {
  std::error_code ignored;
  if (loaded.source == "-") {
    loaded.name = "stdin";
    loaded.scene =
        scene::importGltf(readStandardInput(options.maxMemoryBytes), {}, "standard input", options);
  } else if (std::filesystem::exists(loaded.source, ignored)) {
    loaded.name = std::filesystem::path(loaded.source).stem().string();
    loaded.scene = scene::importGltf(std::filesystem::path(loaded.source), options);
  } else if (isBuiltInName(loaded.source)) {
    loaded.name = loaded.source;
    loaded.isBuiltIn = true;
    loaded.scene = scene::importGltf(scene::makeBuiltInScene(loaded.source), {}, loaded.source, options);
  } else {
    throwNotFound(loaded.source);
  }
}

void sayWarnings(const scene::Scene& scene) {
  for (std::size_t i = 0; i < scene.warnings.size(); ++i)
    if (i < kWarningsShown)
      sayWarning(scene.warnings[i]);
    else
      sayDetail("warning: " + scene.warnings[i]);
  if (scene.warnings.size() > kWarningsShown)
    sayWarning(fmt::format("{} more; --verbose shows all", scene.warnings.size() - kWarningsShown));
}

/// A hint overrides the automatic rule, so a hint on everything switches it off.
void forbidReflectors(scene::Scene& scene) {
  for (scene::Material& material : scene.materials) material.hint.reflector = false;
  for (scene::Instance& instance : scene.instances) instance.hint.reflector = false;
}

/// Brings the scene to the time that was asked for.
void startMotion(LoadedScene& loaded, const SceneOptions& options) {
  if (!options.timeS && options.animation.empty()) return;
  checkMotion(loaded, options);
  loaded.motion = std::make_unique<scene::WorldMotion>(loaded.scene, loaded.geometry, options.reflectors,
                                                       options.animation);
  loaded.motion->setTime(options.timeS.value_or(0.0));
}

scene::Camera findCamera(const LoadedScene& loaded, const std::string& name) {
  const auto& cameras = loaded.scene.cameras;
  std::vector<std::string> names;
  for (const scene::Camera& camera : cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (error == std::errc{} && end == name.data() + name.size() && index < cameras.size())
    return cameras[index];
  const std::string hint = cameras.empty()
                               ? "the scene has no cameras; use --eye and --target"
                               : fmt::format("it has {}: {}", cameras.size(), fmt::join(names, ", "));
  throw core::Error("camera.unknown", "there is no camera '" + name + "' in '" + loaded.source + "'", {},
                    makeSuggestion(name, names, hint));
}

void refuseContradictions(const CameraOptions& options) {
  const bool orbits = options.azimuthDegrees || options.elevationDegrees;
  if (options.camera && (options.eye || options.target || options.up || orbits))
    throw UsageError("--camera excludes --eye, --target, --up, --azimuth and --elevation");
  if (orbits && (options.eye || options.target || options.up))
    throw UsageError("--azimuth and --elevation exclude --eye, --target and --up");
  if (!options.eye && (options.target || options.up)) throw UsageError("--target and --up need --eye");
}

}  // namespace

std::unique_ptr<LoadedScene> loadScene(const std::string& source, const SceneOptions& options) {
  if (options.noReflectors && !options.reflectors.only.empty())
    throw UsageError("--no-reflectors and --reflector exclude each other");
  auto loaded = std::make_unique<LoadedScene>();
  loaded->source = source;
  importInto(*loaded, options.import);
  sayWarnings(loaded->scene);
  if (options.noReflectors) forbidReflectors(loaded->scene);
  loaded->geometry = scene::makeWorldGeometry(loaded->scene, options.reflectors);
  loaded->reflectorOptions = options.reflectors;
  loaded->animation = options.animation;
  startMotion(*loaded, options);
  sayDetail(fmt::format("{}: {} triangles, {} reflectors", source, loaded->geometry.triangleCount(),
                        loaded->geometry.reflectors.size()));
  return loaded;
}

void checkMotion(const LoadedScene& loaded, const SceneOptions& options) {
  if ((options.timeS || !options.animation.empty()) && loaded.scene.motion.isEmpty())
    throw core::Error("animation.none", "'" + loaded.source + "' has no animations", {},
                      "leave --time, --animation and --frames out");
}

void checkSource(const std::string& source) {
  std::error_code ignored;
  if (source != "-" && !std::filesystem::exists(source, ignored) && !isBuiltInName(source))
    throwNotFound(source);
}

scene::Environment makeEnvironmentFrom(const std::string& file) {
  return file.empty() ? scene::makeSkyEnvironment() : scene::readEnvironment(file);
}

void loadEnvironment(LoadedScene& loaded, const std::string& file) {
  loaded.environment = makeEnvironmentFrom(file);
}

scene::Camera chooseCamera(const LoadedScene& loaded, const CameraOptions& options) {
  refuseContradictions(options);
  const bool orbits = options.azimuthDegrees || options.elevationDegrees;
  scene::Camera camera;
  if (options.camera) {
    camera = findCamera(loaded, *options.camera);
  } else if (options.eye) {
    camera.name = "eye";
    camera.eye = *options.eye;
    camera.target = options.target.value_or(
        loaded.geometry.bounds.isEmpty() ? dvec3(0) : loaded.geometry.bounds.centre());
    camera.up = options.up.value_or(dvec3(0, 1, 0));
    if (glm::length(camera.target - camera.eye) < 1e-9 || glm::length(camera.up) < 1e-9)
      throw UsageError("--eye and --target are the same point, or --up has no length");
  } else if (orbits || loaded.scene.cameras.empty()) {
    const scene::Camera fromFront = scene::makeFrameAllCamera(loaded.geometry.bounds);
    camera = scene::makeFrameAllCamera(
        loaded.geometry.bounds, options.azimuthDegrees ? glm::radians(*options.azimuthDegrees) : 0.6,
        options.elevationDegrees ? glm::radians(*options.elevationDegrees) : 0.35,
        options.fovDegrees ? glm::radians(*options.fovDegrees) : fromFront.fovYRadians);
  } else {
    camera = loaded.scene.cameras.front();
  }
  if (options.fovDegrees) camera.fovYRadians = glm::radians(*options.fovDegrees);
  return camera;
}

}  // namespace catoptric::app
