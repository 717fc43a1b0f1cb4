// SPDX-License-Identifier: Apache-2.0
#include "viewer/environment_panel.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "viewer/dropped_files.h"

namespace catoptric::viewer {
namespace {

constexpr const char* kSky = "built-in sky";
constexpr std::size_t kMostListed = 200;

/// The folder in which others may lie.
std::filesystem::path findFolder(const Model& model) {
  const LoadRequest& request = model.loaded.request;
  const bool isFile = !model.loaded.scene->isBuiltIn && request.source != "-";
  const std::string& beside = request.environment.empty() && isFile ? request.source : request.environment;
  const std::filesystem::path folder = std::filesystem::path(beside).parent_path();
  return folder.empty() ? "." : folder;
}

std::vector<std::string> listFiles(const Model& model) {
  std::vector<std::string> files = model.environments;
  const std::filesystem::path folder = findFolder(model);
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(folder, ignored), end; entry != end && !ignored;
       entry.increment(ignored)) {
    const std::string file = folder == "." ? entry->path().filename().string() : entry->path().string();
    if (isEnvironmentFile(file) && files.size() < kMostListed) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

std::string nameOf(const std::string& file) {
  return file.empty() ? kSky : std::filesystem::path(file).filename().string();
}

void drawChoice(Model& model, const std::string& file) {
  const bool isCurrent = file == model.loaded.request.environment;
  ImGui::PushID(file.c_str());
  if (ImGui::Selectable(nameOf(file).c_str(), isCurrent) && !isCurrent) {
    LoadRequest request = model.loaded.request;
    request.environment = file;
    request.keepsCamera = true;
    model.wishes.load = request;
  }
  if (!file.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
  ImGui::PopID();
}

}  // namespace

void drawEnvironments(Model& model) {
  ImGui::PushItemWidth(180);
  if (ImGui::BeginCombo("surroundings", nameOf(model.loaded.request.environment).c_str())) {
    if (ImGui::IsWindowAppearing()) model.environmentsListed = listFiles(model);
    drawChoice(model, "");
    for (const std::string& file : model.environmentsListed) drawChoice(model, file);
    ImGui::EndCombo();
  }
  ImGui::PopItemWidth();
}

}  // namespace catoptric::viewer
