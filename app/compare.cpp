// SPDX-License-Identifier: Apache-2.0
// catoptric compare SCENE... -o DIR: every method against ray-traced truth.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/progress.h"
#include "command_line.h"
#include "commands.h"
#include "comparison_limits.h"
#include "comparison_page.h"
#include "option_values.h"
#include "terminal.h"
#include "zexel_options.h"

namespace catoptric::app {
namespace {

constexpr int kMostRepeats = 1000;

struct Options {
  std::vector<std::string> sources;
  std::string folder;
  std::vector<MethodVariant> variants = defaultVariants();
  int repeats = 3;
  std::vector<ivec2> sizes;
  bool allCameras = false;
  Limits limits;
  SceneOptions scene;
  CameraOptions camera;
  PictureOptions picture;
  OutputOptions output;
};

/// A folder name that no other view has: letters, digits, '-', '_' and '.' only.
std::string makeViewFolder(const std::string& name, std::set<std::string>& taken) {
  std::string folder;
  for (const char c : name) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '-' || c == '_' || (c == '.' && !folder.empty());
    folder += isPlain ? c : '_';
  }
  if (folder.empty()) folder = "scene";
  folder = folder.substr(0, 100);
  std::string unique = folder;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}-{}", folder, i);
  return unique;
}

std::vector<scene::Camera> chooseCameras(const LoadedScene& loaded, const Options& options) {
  if (!options.allCameras || loaded.scene.cameras.empty()) return {chooseCamera(loaded, options.camera)};
  return loaded.scene.cameras;
}

/// Compares all views of one scene. `gl` keeps what the first renderer says of itself.
void compareScene(const std::string& source, const Options& options, const std::string& command,
                  std::set<std::string>& takenFolders, std::vector<Comparison>& comparisons, Json& document) {
  const auto loaded = loadScene(source, options.scene);
  loadEnvironment(*loaded, options.picture.environment);
  renderer::Renderer renderer(loaded->scene, loaded->geometry, loaded->environment);
  const auto cameras = chooseCameras(*loaded, options);
  for (const scene::Camera& camera : cameras) {
    const std::string viewName = cameras.size() > 1 ? loaded->name + "-" + camera.name : loaded->name;
    ComparisonOptions view{options.picture.frame,
                           options.picture.exposure,
                           options.variants,
                           options.repeats,
                           options.sizes,
                           options.folder,
                           makeViewFolder(viewName, takenFolders)};
    core::Progress progress(viewName, countSteps(view));
    comparisons.push_back(compareView(*loaded, renderer, camera, view, progress));
  }
  renderer.saveReferenceImages();
  if (document.is_null()) {
    document = makeDocument("compare", &renderer);
    document["command_line"] = command;
  }
}

/// The pictures are there already; now the two files that refer to them.
void writeReport(const Options& options, const std::vector<Comparison>& comparisons, const Json& document,
                 const std::string& command) {
  const std::filesystem::path folder(options.folder);
  core::writeFileAtomically(folder / "report.json", serialise(document));
  core::writeFileAtomically(folder / "index.html", makeComparisonPage(comparisons, document, command));
  if (options.output.json != "-")
    printData(formatTable(makeRows(comparisons), usesColour(stdout), 2) +
              "\npictures, error maps and this table: " + (folder / "index.html").string() +
              "\nall figures: " + (folder / "report.json").string() + "\n");
  writeDocument(options.output.json, document);
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw core::Error("file.write", "cannot make the folder '" + folder + "': " + error.message());
}

/// What was typed, so that it can be typed again.
std::string quoteLine(const std::vector<std::string>& line) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,=+:%@";
  std::string text = "catoptric";
  for (const std::string& word : line) {
    std::string quoted = word;
    if (word.empty() || word.find_first_not_of(kPlain) != std::string::npos) {
      for (std::size_t at = 0; (at = quoted.find('\'', at)) != std::string::npos; at += 4)
        quoted.replace(at, 1, "'\\''");
      quoted.insert(0, 1, '\'').push_back('\'');
    }
    text.append(" ").append(quoted);
  }
  return text;
}

int run(Options options, const std::vector<std::string>& line) {
  applyOutput(options.output);
  if (options.folder.empty()) throw UsageError("where to write to is missing", "add -o DIR");
  if (options.allCameras && (options.camera.camera || options.camera.eye || options.camera.azimuthDegrees))
    throw UsageError("--all-cameras excludes other cameras");
  std::erase_if(options.variants,
                [](const MethodVariant& v) { return v.method == renderer::Method::RayTrace; });
  if (options.variants.empty()) throw UsageError("--methods: there is nothing to compare with the truth");
  checkLimits(options.limits, options.variants);
  checkVariants(options.picture.frame, options.variants);
  for (const std::string& source : options.sources) checkSource(source);
  makeFolder(options.folder);

  const std::string command = quoteLine(line);
  std::set<std::string> takenFolders;
  std::vector<Comparison> comparisons;
  Json document;
  for (const std::string& source : options.sources)
    compareScene(source, options, command, takenFolders, comparisons, document);

  const auto exceeded = findExceeded(options.limits, comparisons);
  document["results"] = Json::array();
  for (const Comparison& comparison : comparisons)
    for (const ComparisonRow& row : comparison.rows) document["results"].push_back(makeJson(comparison, row));
  document["exceeded"] = exceeded;
  writeReport(options, comparisons, document, command);
  for (const std::string& limit : exceeded) sayError(limit);
  return exceeded.empty() ? kDone : kLimitExceeded;
}

void declare(Arguments& arguments, const std::shared_ptr<Options>& options) {
  arguments.positional("SCENE", "One or more .gltf or .glb files or built-in scenes",
                       Arguments::Count::OneOrMore,
                       [options](const std::string& text) { options->sources.push_back(text); });
  arguments.group("Comparison");
  arguments.option("-o,--output", "DIR", "Folder for index.html, report.json and the pictures",
                   setText(options->folder));
  arguments.option("--methods", "A,B,C", "Which ones: " + listMethodNames() + "; default: all but morphing",
                   [options](const std::string& text) { options->variants = parseMethodList(text); });
  arguments.option("--repeat", "N", "Frames of each method that are timed; default 3",
                   setInteger("--repeat", options->repeats, 1, kMostRepeats));
  arguments.option("--sizes", "WxH,WxH", "Also times the methods at these sizes: time against resolution",
                   [options](const std::string& text) {
                     for (const std::string& size : splitList(text))
                       options->sizes.push_back(parseSize("--sizes", size));
                   });
  arguments.flag("--all-cameras", "Compare from each camera of the scene", options->allCameras);
  declareBaked(arguments, options->picture.frame);
  declareLimits(arguments, options->limits);
  declarePicture(arguments, options->picture);
  declareBackend(arguments, options->picture.frame);
  declareMerge(arguments, options->picture.frame);
  declareZexels(arguments, options->picture.frame.zexel);
  declareCamera(arguments, options->camera);
  declareScene(arguments, options->scene);
  declareMotion(arguments, options->scene);
  declareOutput(arguments, options->output);
}

}  // namespace

Command makeCompareCommand() {
  const auto options = std::make_shared<Options>();
  return {
      .name = "compare",
      .summary = "Every method against ray-traced truth: pictures, error maps, a table",
      .examples =
          "  catoptric compare four-spheres -o report\n"
          "  catoptric compare scene.glb hall-of-mirrors -o report --bounces 4\n"
          "  catoptric compare fender -o report --methods virtual-refined --max-median 0.5 "
          "--min-within-1px 90%\n"
          "  catoptric compare drivers-view -o report --no-reflectors --methods none --min-direct 99.5%\n",
      .declare = [options](Arguments& arguments) { declare(arguments, options); },
      .run = [options](const std::vector<std::string>& line) { return run(*options, line); }};
}

}  // namespace catoptric::app
