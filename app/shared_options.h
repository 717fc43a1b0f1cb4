// SPDX-License-Identifier: Apache-2.0
// Options that several commands share, each with the function that declares it (docs/command-line.md).
#pragma once

#include <optional>
#include <string>

#include "arguments.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/scene/gltf_import.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::app {

struct OutputOptions {
  std::string json;  ///< --json FILE; "-" is stdout
  bool quiet = false, verbose = false;
  int threads = 0;  ///< 0 = all
};

struct SceneOptions {
  scene::ImportOptions import;
  scene::ReflectorOptions reflectors;
  bool noReflectors = false;    ///< --no-reflectors: no material is a mirror
  std::optional<double> timeS;  ///< --time; absent = rest pose
  std::string animation;        ///< --animation; empty = all that go together
};

struct CameraOptions {
  std::optional<std::string> camera;
  std::optional<dvec3> eye, target, up;
  std::optional<double> fovDegrees, azimuthDegrees, elevationDegrees;
};

struct PictureOptions {
  renderer::FrameOptions frame;
  std::string environment;  ///< file; empty = the built-in sky
  float exposure = 1;
};

void declareOutput(Arguments& arguments, OutputOptions& options);
void declareScene(Arguments& arguments, SceneOptions& options);
/// --time, --animation.
void declareMotion(Arguments& arguments, SceneOptions& options);
void declareCamera(Arguments& arguments, CameraOptions& options);
/// Of --merge. Throws UsageError; `option` is what the text was given to.
[[nodiscard]] renderer::Merge parseMerge(const std::string& option, const std::string& text);
/// --merge, --texture-scale.
void declareMerge(Arguments& arguments, renderer::FrameOptions& frame);
/// Throws UsageError for a --texture-scale that would change nothing.
void checkMerge(const renderer::FrameOptions& options, bool usesTexture);
/// What is asked of a picture before it is drawn: --size, --bounces, --max-error.
void declareFrame(Arguments& arguments, renderer::FrameOptions& frame);
/// What is drawn however it is drawn: those, --samples, --environment, --exposure.
void declarePicture(Arguments& arguments, PictureOptions& options);
/// --backend, --parts
void declareBackend(Arguments& arguments, renderer::FrameOptions& options);
/// --baked
void declareBaked(Arguments& arguments, renderer::FrameOptions& options);
/// --method, --solver, --baked, --plain-environment-map (FrameOptions::boxCorrected is its opposite).
void declareMethod(Arguments& arguments, renderer::FrameOptions& options, bool& plainMap);
/// Throws UsageError for a --solver, --baked, --merge, ... of another method, which would change nothing.
void checkMethod(const renderer::FrameOptions& options);

/// Verbosity and threads; call it first in a command.
void applyOutput(const OutputOptions& options);

}  // namespace catoptric::app
