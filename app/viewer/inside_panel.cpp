// SPDX-License-Identifier: Apache-2.0
#include "viewer/inside_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/camera_control.h"

namespace catoptric::viewer {
namespace {

void moveCamera(ViewState& view) {
  const ImGuiIO& io = ImGui::GetIO();
  const dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemActive() && moved != dvec2(0)) {
    if (io.KeyShift)
      pan(view.elsewhere, moved, view.elsewherePx.y);
    else
      orbit(view.elsewhere, moved);
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) zoom(view.elsewhere, io.MouseWheel);
}

bool isDrawnExactly(const Model& model, const scene::Reflector& mirror) {
  const app::MethodVariant& variant = model.variants[model.view.variant];
  if (variant.solver == renderer::Solver::Exact) return true;
  return (variant.method == renderer::Method::Auto || variant.method == renderer::Method::Virtual) &&
         variant.solver == renderer::Solver::Auto && model.choiceOf(mirror).solver == renderer::Solver::Exact;
}

/// Exposures: pixels that no zexel reached.
void drawExposureChoice(Model& model) {
  static constexpr std::array<const char*, 3> kNames{"closed", "open", "marked magenta"};
  depth_reflection_map::ZexelOptions& options = model.view.frame.zexel;
  const bool isOpen = !options.continuesSurfaces && !options.isCoherent;
  int now = options.marksExposures ? 2 : isOpen ? 1 : 0;
  ImGui::PushItemWidth(140);
  if (ImGui::Combo("exposures", &now, kNames.data(), int(kNames.size()))) {
    options.marksExposures = now == 2;
    options.continuesSurfaces = options.isCoherent = now != 1;
    model.wishes.viewChanged = true;
  }
  ImGui::PopItemWidth();
  if (!model.frame.frame) return;
  const renderer::FrameCounters& counters = model.frame.frame->counters;
  ImGui::SameLine();
  ImGui::TextUnformatted(
      fmt::format("{} of {} pixels", counters.uncoveredPixels, counters.zexelPixels).c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("of flat mirrors; %d zexels warped", int(counters.zexels));
}

/// What there is to choose of the method that draws this mirror.
void drawChoices(Model& model, const scene::Reflector& mirror) {
  const renderer::Method method = model.variants[model.view.variant].method;
  raster::MarkOptions& marks = model.view.marks;
  if (method == renderer::Method::Zexel) {
    ImGui::Checkbox("zexels", &marks.zexels);
    ImGui::SameLine();
    drawExposureChoice(model);
  } else if (method == renderer::Method::Morphing) {
    ImGui::Checkbox("sampling cell, rays, octree", &marks.octree);
  } else if (method != renderer::Method::Auto && method != renderer::Method::Virtual) {
    ImGui::TextUnformatted("this method has nothing to show: virtual, morphing and zexel do (M)");
  } else if (mirror.shape == scene::ReflectorShape::Plane) {
    ImGui::TextUnformatted("flat: the scene is drawn once more, mirrored, and nothing else");
  } else if (isDrawnExactly(model, mirror)) {
    ImGui::TextUnformatted("drawn by solver exact, which moves no vertices: try virtual-refined (M)");
  } else {
    ImGui::Checkbox("virtual object", &marks.virtualObject);
    ImGui::SameLine();
    ImGui::Checkbox("tessellation", &marks.tessellation);
    ImGui::SameLine();
    ImGui::Checkbox("rays and cells", &marks.cells);
  }
}

}  // namespace

void lookInside(Model& model, std::uint32_t reflector) {
  const scene::Reflector& mirror = model.geometry->reflectors[reflector];
  model.view.insideOf = reflector;
  scene::Camera& camera = model.view.elsewhere;
  camera = model.view.camera;
  const dvec3 away = camera.eye - mirror.centre;
  const renderer::Method method = model.variants[model.view.variant].method;
  if (method == renderer::Method::Morphing || method == renderer::Method::Zexel) {
    // From aside: what these work with lies round the eye, or behind the mirror.
    constexpr double kFromMiddle = 1.5;
    camera.target = mirror.centre + 0.5 * away;
    camera.eye = camera.target + kFromMiddle * away;
    orbit(camera, dvec2(-200, 70));
  } else {  // virtual objects are as small as their mirror
    constexpr double kRadii = 7, kFarther = 1.5;
    camera.target = mirror.centre;
    camera.eye =
        camera.target + away * std::min(kFarther, kRadii * mirror.radius / std::max(glm::length(away), 1e-9));
    orbit(camera, dvec2(-150, 40));
  }
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
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(display.x - 10, display.y - 10), ImGuiCond_FirstUseEver, ImVec2(1, 1));
  ImGui::SetNextWindowSize(ImVec2(std::min(540.0f, display.x - 20), std::min(470.0f, display.y - 20)),
                           ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(240, 180), display);
  if (ImGui::Begin("inside the method", &isShown, ImGuiWindowFlags_NoSavedSettings)) {
    const auto& reflectors = model.geometry->reflectors;
    if (*view.insideOf < reflectors.size()) {
      const scene::Reflector& mirror = reflectors[*view.insideOf];
      ImGui::TextUnformatted((mirror.name + ": drag orbits, wheel zooms").c_str());
      drawChoices(model, mirror);
    }
    const ImVec2 corner = ImGui::GetCursorPos(), left = ImGui::GetContentRegionAvail();
    const ImVec2 size(std::max(16.0f, std::floor(left.x)), std::max(16.0f, std::floor(left.y)));
    view.elsewherePx = ivec2(int(size.x), int(size.y));
    if (!picture.isEmpty()) ImGui::Image(picture.imguiId(), size);
    ImGui::SetCursorPos(corner);
    ImGui::InvisibleButton("camera", size);  // takes the mouse, which would move the window
    moveCamera(view);
  }
  ImGui::End();
  if (!isShown) view.insideOf.reset();
}

}  // namespace catoptric::viewer
