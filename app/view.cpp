// SPDX-License-Identifier: Apache-2.0
// catoptric view [SCENE|FOLDER]: the interactive viewer.
#include <fmt/format.h>

#include <filesystem>
#include <future>
#include <memory>

#include "catoptric/core/error.h"
#include "catoptric/scene/pose.h"
#include "commands.h"
#include "method_variant.h"
#include "option_values.h"
#include "session_file.h"
#include "shared_options.h"
#include "terminal.h"
#include "viewer/dropped_files.h"
#include "viewer/viewer.h"
#include "zexel_options.h"

namespace catoptric::app {
namespace {

constexpr const char* kFirstScene = "four-spheres";  // opened when nothing is named

struct Options {
  std::string source, session;
  bool plainMap = false, watch = false;
  SceneOptions scene;
  CameraOptions camera;
  PictureOptions frame;
  OutputOptions output;
};

/// What was typed that changes the scene and is no mirror's name (the viewer switches those).
std::vector<std::string> findSceneOptions(const std::vector<std::string>& line) {
  static const std::vector<std::string> kWithValue{"--scene", "--reflector-metallic", "--reflector-roughness",
                                                   "--max-memory", "--max-pixels"};
  std::vector<std::string> found;
  for (std::size_t i = 0; i < line.size(); ++i)
    for (const std::string& name : kWithValue) {
      if (line[i].starts_with(name + "=")) found.push_back(line[i]);
      if (line[i] == name && i + 1 < line.size()) found.push_back(name + "=" + line[i + 1]);
    }
  return found;
}

/// All methods, the one that the command line names first among them; it gets a row of its own if it is new.
void listVariants(viewer::ViewerOptions& viewer) {
  viewer.variants = methodVariants();
  const renderer::FrameOptions& wanted = viewer.frame;
  for (std::size_t i = 0; i < viewer.variants.size(); ++i) {
    const MethodVariant& variant = viewer.variants[i];
    if (variant.method == wanted.method && variant.solver == wanted.solver &&
        variant.boxCorrected == wanted.boxCorrected) {
      viewer.variant = i;
      return;
    }
  }
  const std::string name =
      fmt::format("{}, {}", renderer::methodName(wanted.method), renderer::solverName(wanted.solver));
  viewer.variant = viewer.variants.size();
  viewer.variants.push_back(
      {name, "as on the command line", wanted.method, wanted.solver, wanted.boxCorrected});
}

/// What the viewer's loading thread calls.
viewer::LoadResult load(const Options& options, const viewer::LoadRequest& request) {
  const bool isFirst = request.source == options.source;
  SceneOptions sceneOptions = options.scene;
  sceneOptions.reflectors.only = request.mirrors;
  sceneOptions.noReflectors = request.noReflectors;
  sceneOptions.timeS.reset();  // the viewer itself moves its scenes
  sceneOptions.animation.clear();
  const auto enter = [&](viewer::LoadStep step) {
    if (request.step) *request.step = step;
  };
  enter(viewer::LoadStep::Scene);
  // Reading a scene leaves a core idle now and then.
  auto surroundings =
      std::async(std::launch::async, [&] { return makeEnvironmentFrom(request.environment); });
  std::shared_ptr<LoadedScene> loaded = loadScene(request.source, sceneOptions);
  enter(viewer::LoadStep::Surroundings);
  loaded->environment = surroundings.get();
  enter(viewer::LoadStep::Drawing);
  viewer::LoadResult result;
  result.request = request;
  if (isFirst) {
    checkMotion(*loaded, options.scene);
    loaded->animation = options.scene.animation;
    result.timeS = options.scene.timeS;
  }
  result.durationS = scene::chooseAnimations(loaded->scene.motion, loaded->animation).durationS;
  // A camera that was named on the command line belongs to the first scene; others have their own.
  result.camera = chooseCamera(*loaded, isFirst ? options.camera : CameraOptions{});
  result.reflectors = loaded->geometry.reflectors;
  result.scene = std::move(loaded);
  return result;
}

/// Reads the session, as if its scene and options had been typed.
viewer::Session openSession(Options& options) {
  if (!options.source.empty())
    throw UsageError("--session: the session names its scene, '" + options.source + "' is one too many");
  viewer::Session session = readSession(options.session);
  options.source = session.scene.source;
  options.scene = {};
  const Command words{.name = "view",
                      .summary = {},
                      .examples = {},
                      .declare = [&](Arguments& arguments) { declareScene(arguments, options.scene); },
                      .run = {}};
  try {
    std::vector<std::string> line{"view"};
    line.insert(line.end(), session.sceneOptions.begin(), session.sceneOptions.end());
    (void)parseArguments({words}, line);
  } catch (const UsageError& error) {
    throw core::Error("session.invalid",
                      fmt::format("'{}': /scene_options: {}", options.session, error.what()),
                      "/scene_options", error.hint());
  }
  options.scene.reflectors.only = session.scene.mirrors;
  options.scene.noReflectors = session.scene.noReflectors;
  options.scene.animation = session.animation;
  options.scene.timeS = session.state.timeS;
  options.frame.environment = session.scene.environment;
  options.frame.frame = session.frame;
  options.frame.exposure = session.exposure;
  options.plainMap = !session.frame.boxCorrected;
  options.camera = {};
  return session;
}

int run(Options options, const std::vector<std::string>& line) {
  applyOutput(options.output);
  viewer::ViewerOptions viewer;
  if (!options.session.empty()) viewer.session = openSession(options);
  if (options.source == "-" && options.watch) throw UsageError("--watch: standard input cannot be watched");
  if (options.source.empty()) options.source = kFirstScene;
  if (std::filesystem::is_directory(options.source)) {
    viewer.files = viewer::listScenes(options.source);
    options.source = viewer.files.front();
  }
  checkSource(options.source);
  checkMethod(options.frame.frame);
  viewer.scene.source = options.source;
  viewer.scene.environment = options.frame.environment;
  viewer.scene.mirrors = options.scene.reflectors.only;
  viewer.scene.noReflectors = options.scene.noReflectors;
  viewer.frame = options.frame.frame;
  viewer.frame.boxCorrected = !options.plainMap;
  viewer.exposure = options.frame.exposure;
  viewer.watch = options.watch;
  viewer.sceneOptions = viewer.session ? viewer.session->sceneOptions : findSceneOptions(line);
  viewer.sessionFile = options.session;
  viewer.saveSession = writeSession;
  viewer.load = [&options](const viewer::LoadRequest& request) { return load(options, request); };
  viewer.say = say;
  viewer.sayDetail = sayDetail;
  viewer.printLine = [](const std::string& text) { printData(text + "\n"); };
  listVariants(viewer);
  viewer::runViewer(viewer);
  return 0;
}

}  // namespace

Command makeViewCommand() {
  const auto options = std::make_shared<Options>();
  return {.name = "view",
          .summary = "Look at a scene interactively",
          .examples =
              "  catoptric view four-spheres\n"
              "  catoptric view car.glb --watch\n"
              "  catoptric car.glb\n"
              "  catoptric view scenes/ --method virtual --solver explosion\n"
              "  catoptric view --session four-spheres-0001.session.json\n",
          .declare =
              [options](Arguments& arguments) {
                arguments.positional("SCENE",
                                     "A .gltf or .glb file, a folder of them, '-', or a built-in scene",
                                     Arguments::Count::AtMostOne, setText(options->source));
                arguments.group("Viewer");
                arguments.flag("--watch", "Load the file again when it changes", options->watch);
                arguments.option("--session", "FILE", "Return to what ctrl-S has saved",
                                 setText(options->session));
                declareMotion(arguments, options->scene);
                declareMethod(arguments, options->frame.frame, options->plainMap);
                declarePicture(arguments, options->frame);
                declareMerge(arguments, options->frame.frame);
                declareZexels(arguments, options->frame.frame.zexel);
                declareCamera(arguments, options->camera);
                declareScene(arguments, options->scene);
                declareOutput(arguments, options->output);
              },
          .run = [options](const std::vector<std::string>& line) { return run(*options, line); }};
}

}  // namespace catoptric::app
