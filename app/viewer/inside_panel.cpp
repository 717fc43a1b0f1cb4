// SPDX-License-Identifier: Apache-2.0
#include "viewer/inside_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/camera_control.h"

namespace catoptric::viewer {
namespace {

void moveCamera(scene::Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  const dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemActive() && moved != dvec2(0)) {
    if (io.KeyShift)
      pan(camera, moved, kInsideHeightPx);
    else
      orbit(camera, moved);
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) zoom(camera, io.MouseWheel);
}

void drawChoices(raster::MarkOptions& marks) {
  ImGui::Checkbox("virtual object", &marks.virtualObject);
  ImGui::SameLine();
  ImGui::Checkbox("tessellation", &marks.tessellation);
  ImGui::SameLine();
  ImGui::Checkbox("cells", &marks.cells);
  ImGui::SameLine();
  ImGui::Checkbox("ray octree", &marks.octree);
  ImGui::SameLine();
  ImGui::Checkbox("zexels", &marks.zexels);
}

bool isDrawnExactly(const Model& model, const scene::Reflector& mirror) {
  const app::MethodVariant& variant = model.variants[model.view.variant];
  if (variant.solver == renderer::Solver::Exact) return true;
  return (variant.method == renderer::Method::Auto || variant.method == renderer::Method::Virtual) &&
         variant.solver == renderer::Solver::Auto &&
         renderer::Renderer::chooseMethod(mirror).solver == renderer::Solver::Exact;
}

/// Exposures: pixels that no zexel reached show the surroundings, not what they are closed with.
void drawZexelChoice(Model& model) {
  depth_reflection_map::ZexelOptions& options = model.view.frame.zexel;
  bool isBare = !options.continuesSurfaces && !options.isCoherent;
  if (ImGui::Checkbox("leave exposures open", &isBare)) {
    options.continuesSurfaces = options.isCoherent = !isBare;
    model.wishes.viewChanged = true;
  }
  if (!model.frame.frame) return;
  const renderer::FrameCounters& counters = model.frame.frame->counters;
  ImGui::SameLine();
  ImGui::TextUnformatted(fmt::format("{} of {} mirror pixels exposed, {} zexels warped",
                                     counters.uncoveredPixels, counters.zexelPixels, counters.zexels)
                             .c_str());
}

}  // namespace

void lookInside(Model& model, std::uint32_t reflector) {
  const scene::Reflector& mirror = model.geometry->reflectors[reflector];
  model.view.insideOf = reflector;
  scene::Camera& camera = model.view.elsewhere;
  camera = model.view.camera;
  camera.target = mirror.centre;
  const dvec3 away = camera.eye - camera.target;
  camera.eye = camera.target + 1.5 * away;
  orbit(camera, dvec2(-150, 40));
}

void switchInside(Model& model) {
  if (model.view.insideOf) return model.view.insideOf.reset();
  const auto& reflectors = model.geometry->reflectors;
  if (reflectors.empty()) return;
  std::uint32_t wanted = 0;
  const auto curved = std::find_if(reflectors.begin(), reflectors.end(), [](const scene::Reflector& r) {
    return r.shape != scene::ReflectorShape::Plane;
  });
  if (curved != reflectors.end()) wanted = std::uint32_t(curved - reflectors.begin());
  if (model.picked && model.picked->seen.isMirror() && model.picked->seen.firstReflector < reflectors.size())
    wanted = model.picked->seen.firstReflector;
  lookInside(model, wanted);
}

void drawInside(Model& model, const ShownPicture& picture) {
  ViewState& view = model.view;
  if (!view.insideOf) return;
  bool isShown = true;
  ImGui::SetNextWindowPos(ImVec2(std::max(10.0f, ImGui::GetIO().DisplaySize.x - kInsideWidthPx - 30.0f),
                                 std::max(10.0f, ImGui::GetIO().DisplaySize.y - kInsideHeightPx - 110.0f)),
                          ImGuiCond_FirstUseEver);
  if (ImGui::Begin("inside the method", &isShown,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    const auto& reflectors = model.geometry->reflectors;
    if (*view.insideOf < reflectors.size())
      ImGui::TextUnformatted((reflectors[*view.insideOf].name + ": drag orbits, wheel zooms").c_str());
    drawChoices(view.marks);
    if (model.variants[view.variant].method == renderer::Method::Zexel) drawZexelChoice(model);
    if (*view.insideOf < reflectors.size() && isDrawnExactly(model, reflectors[*view.insideOf]))
      ImGui::TextUnformatted(
          "drawn by the exact solver, which moves no vertices: choose virtual-refined (M)");
    const ImVec2 corner = ImGui::GetCursorPos(), size{float(kInsideWidthPx), float(kInsideHeightPx)};
    if (!picture.isEmpty()) ImGui::Image(picture.imguiId(), size);
    ImGui::SetCursorPos(corner);
    ImGui::InvisibleButton("camera", size);  // takes the mouse, which would move the window
    moveCamera(view.elsewhere);
  }
  ImGui::End();
  if (!isShown) view.insideOf.reset();
}

}  // namespace catoptric::viewer
