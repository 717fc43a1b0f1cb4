// SPDX-License-Identifier: Apache-2.0
#include "viewer/scene_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "viewer/inside_panel.h"

namespace catoptric::viewer {
namespace {

constexpr float kMapEdge = 256;          // a map's own size
constexpr float kBesideMainPx = 345;     // where the main panel leaves room
constexpr float kMapsMarginPx = 2 * 24;  // of the three maps' window and between them

std::string describeShape(const scene::Reflector& reflector) {
  const bool isFreeForm = reflector.shape >= scene::ReflectorShape::Extrusion;
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
  const renderer::MethodChoice choice = model.choiceOf(reflector);
  ImGui::TextUnformatted(
      reflector.shape == scene::ReflectorShape::Plane
          ? "planar mirror"
          : fmt::format("{}, {}", renderer::methodName(choice.method), renderer::solverName(choice.solver))
                .c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", choice.reason.c_str());
  ImGui::TableNextColumn();
  if (!on) return;
  const auto& now = model.geometry->reflectors;
  const auto found = std::find_if(now.begin(), now.end(),
                                  [&](const scene::Reflector& r) { return r.name == reflector.name; });
  const auto index = std::uint32_t(found - now.begin());
  if (found == now.end()) return;
  if (ImGui::SmallButton("inside")) lookInside(model, index);
  ImGui::SameLine();
  if (reflector.shape != scene::ReflectorShape::Plane && ImGui::SmallButton("maps"))
    model.view.mapsOf = index;
}

/// Three maps beside the main panel, in their own size where the window is wide enough.
float findMapEdge() {
  return std::clamp((ImGui::GetIO().DisplaySize.x - kBesideMainPx - kMapsMarginPx) / 3, 0.5f * kMapEdge,
                    kMapEdge);
}

/// `place`: of the point under the mouse, share of the map from its lower left corner.
void drawMap(const char* title, const ShownPicture& picture, const std::optional<dvec2>& place) {
  const float edge = findMapEdge();
  ImGui::BeginGroup();
  ImGui::TextUnformatted(title);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  if (picture.isEmpty())
    ImGui::Dummy(ImVec2(edge, edge));  // the window keeps its size
  else
    ImGui::Image(picture.imguiId(), ImVec2(edge, edge), ImVec2(0, 1), ImVec2(1, 0));
  if (place && glm::all(glm::greaterThanEqual(*place, dvec2(0))) &&
      glm::all(glm::lessThanEqual(*place, dvec2(1)))) {
    const ImVec2 at(corner.x + float(place->x) * edge, corner.y + float(1 - place->y) * edge);
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const auto& [color, width] : {std::pair(IM_COL32(0, 0, 0, 255), 3.0f), {IM_COL32_WHITE, 1.0f}}) {
      list->AddLine(ImVec2(at.x - 7, at.y), ImVec2(at.x + 7, at.y), color, width);
      list->AddLine(ImVec2(at.x, at.y - 7), ImVec2(at.x, at.y + 7), color, width);
    }
  }
  ImGui::EndGroup();
}

/// Of the scene point that is seen, directly or in mirrors.
std::optional<MapPlaces> findPlaces(const Model& model) {
  if (!model.picked || model.picked->seen.isSky() || !model.maps->findPlaces) return std::nullopt;
  return model.maps->findPlaces(dvec3(model.picked->seen.point));
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
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - 10, 10), ImGuiCond_FirstUseEver,
                          ImVec2(1, 0));
  ImGui::SetNextWindowBgAlpha(0.9f);
  if (ImGui::Begin("explosion maps", &isShown,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    const auto& reflectors = model.geometry->reflectors;
    if (*model.view.mapsOf < reflectors.size())
      ImGui::TextUnformatted(reflectors[*model.view.mapsOf].name.c_str());
    const bool isThere = model.maps && model.maps->request.geometry == model.geometry &&
                         model.maps->request.reflector == *model.view.mapsOf;
    static const ShownPicture kNone;
    const bool hasMaps = isThere && model.maps->canReflect;
    if (!isThere)
      ImGui::TextUnformatted("...");
    else if (!hasMaps)
      ImGui::TextUnformatted("flat, or the eye sees none of its front: it has no maps");
    else
      ImGui::TextUnformatted(
          fmt::format("{} triangles, a colour each; dim: extension polygons", model.maps->triangles).c_str());
    const std::optional<MapPlaces> places = hasMaps ? findPlaces(model) : std::nullopt;
    const auto onSphere = places ? std::optional(places->explosion) : std::nullopt;
    drawMap("near", hasMaps ? maps.nearMap : kNone, onSphere);
    ImGui::SameLine();
    drawMap("far", hasMaps ? maps.farMap : kNone, onSphere);
    ImGui::SameLine();
    drawMap("hidden, as the eye sees it", hasMaps ? maps.hiddenMap : kNone,
            places ? std::optional(places->hidden) : std::nullopt);
    ImGui::TextUnformatted("cross: where the scene point under the mouse is looked up");
  }
  ImGui::End();
  if (!isShown) model.view.mapsOf.reset();
}

}  // namespace catoptric::viewer
