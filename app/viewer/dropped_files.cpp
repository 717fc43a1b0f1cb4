// SPDX-License-Identifier: Apache-2.0
#include "viewer/dropped_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "catoptric/core/error.h"

namespace catoptric::viewer {
namespace {

std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

bool isSceneFile(const std::filesystem::path& file) {
  const std::string extension = lowerExtension(file);
  return extension == ".glb" || extension == ".gltf";
}

}  // namespace

bool isEnvironmentFile(const std::string& file) {
  const std::string extension = lowerExtension(file);
  return extension == ".hdr" || extension == ".exr";
}

std::vector<std::string> listScenes(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && isSceneFile(entry.path())) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw core::Error("file.not_found", "there is no .gltf or .glb file in the folder '" + folder + "'", {},
                      "'catoptric scenes --all -o DIR' writes the built-in scenes");
  return files;
}

DroppedFiles sortDroppedFiles(std::span<const std::string> files) {
  DroppedFiles sorted;
  std::error_code ignored;
  for (const std::string& file : files) {
    if (std::filesystem::is_directory(file, ignored)) {
      const std::vector<std::string> inside = listScenes(file);
      sorted.scenes.insert(sorted.scenes.end(), inside.begin(), inside.end());
    } else if (isSceneFile(file)) {
      sorted.scenes.push_back(file);
    } else if (isEnvironmentFile(file)) {
      sorted.environment = file;
    }
  }
  std::sort(sorted.scenes.begin(), sorted.scenes.end());
  if (sorted.scenes.empty() && sorted.environment.empty() && !files.empty())
    throw core::Error("file.kind",
                      fmt::format("'{}' is neither a scene nor surroundings",
                                  std::filesystem::path(files.front()).filename().string()),
                      {}, "drop a .gltf or .glb file, a folder of them, or an .hdr or .exr file");
  return sorted;
}

}  // namespace catoptric::viewer
