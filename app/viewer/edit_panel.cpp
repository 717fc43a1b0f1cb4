// SPDX-License-Identifier: Apache-2.0
// A slider that is held changes the scene at once, and becomes one edit when it is let go.
#include "viewer/edit_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace catoptric::viewer {
namespace {

constexpr float kFarthestShift = 1e6f;

void drawShift(Model& model, std::uint32_t instance) {
  const dvec3 before = model.view.state.shiftOf(instance);
  vec3 shift(before);
  if (ImGui::DragFloat3("moved, m", &shift.x, 0.01f, -kFarthestShift, kFarthestShift, "%.3f",
                        ImGuiSliderFlags_AlwaysClamp)) {
    model.view.state.setShift(instance, dvec3(shift));
    model.wishes.viewChanged = true;
  }
  if (ImGui::IsItemActivated()) model.shiftBefore = before;
  if (ImGui::IsItemDeactivatedAfterEdit())
    model.edits.add(ShiftEdit{instance, model.shiftBefore, model.view.state.shiftOf(instance)});
}

void drawMaterial(Model& model, int material) {
  const scene::Material& original = model.loaded.scene->scene.materials[std::size_t(material)];
  const scene::MaterialValues before = model.view.state.valuesOf(material, original);
  scene::MaterialValues values = before;
  const auto item = [&](bool changed) {
    if (changed) {
      model.view.state.setValues(material, original, values);
      model.wishes.viewChanged = true;
    }
    if (ImGui::IsItemActivated()) model.materialBefore = before;
    if (ImGui::IsItemDeactivatedAfterEdit())
      model.edits.add(MaterialEdit{std::uint32_t(material), model.materialBefore,
                                   model.view.state.valuesOf(material, original)});
  };
  ImGui::TextUnformatted(
      fmt::format("material {}", original.name.empty() ? std::to_string(material) : original.name).c_str());
  item(ImGui::SliderFloat("roughness", &values.roughness, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp));
  item(ImGui::SliderFloat("metallic", &values.metallic, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp));
  item(ImGui::ColorEdit3("tint", &values.tint.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoPicker));
  item(ImGui::SliderFloat("reflectivity", &values.reflectivity, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp));
}

}  // namespace

void drawSelected(Model& model) {
  const auto& instances = model.loaded.scene->scene.instances;
  if (!model.view.selected || model.view.selected->instance >= instances.size()) {
    ImGui::TextUnformatted("ctrl-click picks an object, ctrl-drag moves it");
  } else {
    ImGui::PushItemWidth(180);
    ImGui::TextUnformatted(instances[model.view.selected->instance].name.c_str());
    drawShift(model, model.view.selected->instance);
    if (model.view.selected->material >= 0) drawMaterial(model, model.view.selected->material);
    ImGui::PopItemWidth();
  }
  ImGui::BeginDisabled(!model.edits.canUndo());
  if (ImGui::Button("undo (ctrl-Z)")) model.wishes.undo = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!model.edits.canRedo());
  if (ImGui::Button("redo (ctrl-shift-Z)")) model.wishes.redo = true;
  ImGui::EndDisabled();
}

void drawAnimation(Model& model) {
  if (model.loaded.durationS <= 0) return ImGui::TextUnformatted("the scene has no animations");
  if (ImGui::Button(model.view.isPlaying ? "pause (space)" : "play (space)"))
    model.view.isPlaying = !model.view.isPlaying;
  ImGui::SameLine();
  ImGui::PushItemWidth(180);
  float time = float(model.view.state.timeS.value_or(0.0));
  if (ImGui::SliderFloat("s", &time, 0, float(model.loaded.durationS), "%.2f",
                         ImGuiSliderFlags_AlwaysClamp)) {
    model.view.state.timeS = std::clamp(double(time), 0.0, model.loaded.durationS);
    model.wishes.viewChanged = true;
  }
  ImGui::PopItemWidth();
}

}  // namespace catoptric::viewer
