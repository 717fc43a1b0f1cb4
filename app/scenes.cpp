// SPDX-License-Identifier: Apache-2.0
// catoptric scenes [NAME] [-o DIR]: list the built-in scenes, or write them as .glb.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/progress.h"
#include "catoptric/scene/built_in_scenes.h"
#include "commands.h"
#include "documents.h"
#include "option_values.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

struct Options {
  std::string name, folder;
  bool all = false;
  OutputOptions output;
};

Json describeScenes(const std::vector<std::string>& names, const std::vector<std::string>& files) {
  Json list = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
      if (builtIn.name == names[i]) {
        Json row{{"name", names[i]}, {"description", std::string(builtIn.description)}};
        if (!files.empty()) row["file"] = files[i];
        list.push_back(row);
      }
  return list;
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw core::Error("file.write", "cannot make the folder '" + folder + "': " + error.message());
}

std::vector<std::string> writeScenes(const std::vector<std::string>& names, const std::string& folder) {
  std::vector<std::string> files;
  core::Progress progress("writing scenes", names.size());
  for (const std::string& name : names) {
    progress.describe(name);
    const std::filesystem::path file = std::filesystem::path(folder) / (name + ".glb");
    const std::vector<std::byte> glb = scene::makeBuiltInScene(name);
    makeFolder(folder);  // not before: a name that is none leaves no folder behind
    core::writeFileAtomically(file, std::span<const std::byte>(glb));
    files.push_back(file.string());
    progress.advance();
  }
  return files;
}

int run(const Options& options) {
  applyOutput(options.output);
  if (options.all && !options.name.empty()) throw UsageError("a NAME and --all exclude each other");
  if ((options.all || !options.name.empty()) && options.folder.empty())
    throw UsageError("where to write to is missing", "add -o DIR");
  std::vector<std::string> names;
  if (options.name.empty())
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes()) names.emplace_back(builtIn.name);
  else
    names.push_back(options.name);

  std::vector<std::string> files;
  if (!options.folder.empty()) files = writeScenes(names, options.folder);
  for (const std::string& file : files) say("wrote " + file);
  if (!options.output.json.empty()) {
    Json document = makeDocument("scenes", nullptr);
    document["results"] = describeScenes(names, files);
    writeDocument(options.output.json, document);
  }
  if (options.output.json == "-" || !files.empty()) return 0;
  std::string text;
  for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
    text += fmt::format("{:<24}{}\n", builtIn.name, builtIn.description);
  printData(text);
  return 0;
}

}  // namespace

Command makeScenesCommand() {
  const auto options = std::make_shared<Options>();
  return {.name = "scenes",
          .summary = "List the built-in scenes, or write them as .glb files",
          .examples =
              "  catoptric scenes\n"
              "  catoptric scenes -o scenes\n"
              "  catoptric scenes drivers-view -o scenes\n",
          .declare =
              [options](Arguments& arguments) {
                arguments.positional("NAME", "The scene to write; default: all", Arguments::Count::AtMostOne,
                                     setText(options->name));
                arguments.group("Scenes");
                arguments.option("-o,--output", "DIR", "Folder to write to; without it the scenes are listed",
                                 setText(options->folder));
                arguments.flag("--all", "Write all of them", options->all);
                declareOutput(arguments, options->output);
              },
          .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app
