// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace catoptric::viewer {
namespace {

constexpr float kMapEdge = 200, kMapsWidth = 3 * kMapEdge + 50;  // three maps, gaps, borders

std::string describeShape(const scene::Reflector& reflector) {
  const bool isFreeForm =
      reflector.shape == scene::ReflectorShape::Extrusion || reflector.shape == scene::ReflectorShape::Mesh;
  return (isFreeForm && reflector.isConvex ? "convex " : "") + std::string(scene::shapeName(reflector.shape));
}

bool isMirrorNow(const Model& model, const std::string& name) {
  const auto& now = model.geometry->reflectors;
  return std::any_of(now.begin(), now.end(), [&](const scene::Reflector& r) { return r.name == name; });
}

/// The scene again, with this mirror on or off.
LoadRequest switchMirror(const Model& model, const std::string& name, bool on) {
  LoadRequest request = model.loaded.request;
  request.keepsCamera = true;
  request.mirrors.clear();
  for (const scene::Reflector& reflector : model.loaded.reflectors)
    if (reflector.name == name ? on : isMirrorNow(model, reflector.name))
      request.mirrors.push_back(reflector.name);
  request.noReflectors = request.mirrors.empty();
  if (request.mirrors.size() == model.loaded.reflectors.size()) request.mirrors.clear();
  return request;
}

void drawReflectorRow(Model& model, const scene::Reflector& reflector) {
  bool on = isMirrorNow(model, reflector.name);
  ImGui::TableNextColumn();
  if (ImGui::Checkbox(reflector.name.c_str(), &on) && !model.isLoading)
    model.wishes.load = switchMirror(model, reflector.name, on);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", reflector.reason.c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(describeShape(reflector).c_str());
  ImGui::TableNextColumn();
  const renderer::MethodChoice choice = renderer::Renderer::chooseMethod(reflector);
  ImGui::TextUnformatted(
      reflector.shape == scene::ReflectorShape::Plane
          ? "planar mirror"
          : fmt::format("{}, {}", renderer::methodName(choice.method), renderer::solverName(choice.solver))
                .c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", choice.reason.c_str());
  ImGui::TableNextColumn();
  if (on && reflector.shape != scene::ReflectorShape::Plane && ImGui::SmallButton("maps")) {
    const auto& now = model.geometry->reflectors;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i].name == reflector.name) model.view.mapsOf = std::uint32_t(i);
  }
}

void drawMap(const char* title, const ShownPicture& picture) {
  ImGui::BeginGroup();
  ImGui::TextUnformatted(title);
  if (!picture.isEmpty())
    ImGui::Image(picture.imguiId(), ImVec2(kMapEdge, kMapEdge), ImVec2(0, 1), ImVec2(1, 0));
  ImGui::EndGroup();
}

}  // namespace

void drawReflectors(Model& model) {
  std::vector<scene::Reflector> reflectors = model.loaded.reflectors;
  for (const scene::Reflector& now : model.geometry->reflectors)  // and those that an edit has made
    if (std::none_of(reflectors.begin(), reflectors.end(),
                     [&](const scene::Reflector& known) { return known.name == now.name; }))
      reflectors.push_back(now);
  if (reflectors.empty()) return ImGui::TextUnformatted("the scene has no mirrors");
  if (!ImGui::BeginTable("mirrors", 4,
                         ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit,
                         ImVec2(420, std::min(220.0f, 28.0f * float(reflectors.size()) + 8.0f))))
    return;
  for (std::size_t i = 0; i < reflectors.size(); ++i) {
    ImGui::PushID(int(i));
    drawReflectorRow(model, reflectors[i]);
    ImGui::PopID();
  }
  ImGui::EndTable();
}

void drawMaps(Model& model, const MapPictures& maps) {
  if (!model.view.mapsOf) return;
  bool isShown = true;
  // At the right edge, but whole: ImGui does not know its size yet.
  ImGui::SetNextWindowPos(ImVec2(std::max(10.0f, ImGui::GetIO().DisplaySize.x - kMapsWidth), 10),
                          ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.9f);
  if (ImGui::Begin("explosion maps", &isShown,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    const auto& reflectors = model.geometry->reflectors;
    if (*model.view.mapsOf < reflectors.size())
      ImGui::TextUnformatted(reflectors[*model.view.mapsOf].name.c_str());
    if (model.maps && model.maps->request.geometry == model.geometry &&
        model.maps->request.reflector == *model.view.mapsOf) {
      if (!model.maps->canReflect) {
        ImGui::TextUnformatted("flat, or the eye sees none of its front: it has no maps");
      } else {
        ImGui::TextUnformatted(
            fmt::format("{} triangles, a colour each; dim: extension polygons", model.maps->triangles)
                .c_str());
        drawMap("near", maps.nearMap);
        ImGui::SameLine();
        drawMap("far", maps.farMap);
        ImGui::SameLine();
        drawMap("hidden", maps.hiddenMap);
      }
    } else {
      ImGui::TextUnformatted("...");
    }
  }
  ImGui::End();
  if (!isShown) model.view.mapsOf.reset();
}

}  // namespace catoptric::viewer
