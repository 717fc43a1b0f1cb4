// SPDX-License-Identifier: Apache-2.0
#include "viewer/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/camera_control.h"
#include "viewer/edit_panel.h"
#include "viewer/environment_panel.h"
#include "viewer/input.h"
#include "viewer/inside_panel.h"
#include "viewer/scene_panels.h"
#include "viewer/time_graph.h"

namespace catoptric::viewer {
namespace {

constexpr float kPanelWidth = 320;

void showText(const std::string& text) {
  ImGui::TextUnformatted(text.c_str());
}

/// Picks one of an enumeration's values up to `last`; true if it is another one now.
template <class Choice, class NameOf>
bool drawChoice(const char* label, Choice& chosen, Choice last, const NameOf& nameOf) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, std::string(nameOf(chosen)).c_str())) return false;
  for (int i = 0; i <= int(last); ++i) {
    const auto choice = Choice(i);
    if (!ImGui::Selectable(std::string(nameOf(choice)).c_str(), choice == chosen)) continue;
    chosen = choice;
    changed = true;
  }
  ImGui::EndCombo();
  return changed;
}

void drawMethod(Model& model) {
  ViewState& view = model.view;
  bool changed = false;
  ImGui::PushItemWidth(180);
  if (ImGui::BeginCombo("method (M)", model.variants[view.variant].name.c_str())) {
    for (std::size_t i = 0; i < model.variants.size(); ++i) {
      if (ImGui::Selectable(model.variants[i].name.c_str(), i == view.variant)) {
        view.variant = i;
        changed = true;
      }
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", model.variants[i].description.c_str());
    }
    ImGui::EndCombo();
  }
  changed |= ImGui::SliderInt("bounces", &view.frame.bounces, 0, 16);
  float maxErrorPx = float(view.frame.maxErrorPx);
  if (ImGui::SliderFloat("max error, px", &maxErrorPx, 0.1f, 10, "%.2f", ImGuiSliderFlags_Logarithmic)) {
    view.frame.maxErrorPx = std::clamp(double(maxErrorPx), 0.01, 1e6);
    changed = true;
  }
  const app::MethodVariant& variant = model.variants[view.variant];
  if (renderer::hasSolvers(variant.method) && renderer::hasVertexShader(variant.solver))
    changed |= drawChoice("backend", view.frame.backend, renderer::Backend::Gpu, renderer::backendName);
  if (renderer::hasMerges(variant.method))
    changed |= drawChoice("merge", view.frame.merge, renderer::Merge::Texture, renderer::mergeName);
  drawEnvironments(model);
  changed |= ImGui::SliderFloat("exposure", &view.exposure, 0.1f, 10, "%.2f", ImGuiSliderFlags_Logarithmic);
  changed |= ImGui::SliderFloat("resolution", &view.resolution, 0.25f, 1, "%.2f");
  view.frame.bounces = std::clamp(view.frame.bounces, 0, 16);
  view.exposure = std::clamp(view.exposure, 1e-6f, 1e6f);
  view.resolution = std::clamp(view.resolution, 0.1f, 1.0f);
  ImGui::PopItemWidth();
  if (changed) model.wishes.viewChanged = true;
}

void drawComparison(Model& model) {
  int comparison = int(model.view.comparison);
  ImGui::RadioButton("method", &comparison, int(Comparison::None));
  ImGui::SameLine();
  ImGui::RadioButton("split (S)", &comparison, int(Comparison::Split));
  ImGui::RadioButton("difference (D)", &comparison, int(Comparison::Difference));
  ImGui::SameLine();
  ImGui::RadioButton("displacement", &comparison, int(Comparison::Displacement));
  model.view.comparison = Comparison(comparison);
  if (model.view.comparison == Comparison::None) return;
  if (!model.truthIsCurrent()) return showText("the truth is being traced ...");
  const TruthResult& truth = *model.truth;
  showText(fmt::format("truth: pass {} of {}, {} sample{} a pixel{}", truth.pass + 1, kTruthPasses,
                       truth.samples, truth.samples == 1 ? "" : "s", model.isTracing ? " ..." : ""));
  if (truth.difference.isEmpty()) return;
  const metrics::DisplacementStatistics& moved = truth.objectPixels;
  if (moved.pixels > 0)
    showText(
        fmt::format("objects in mirrors: median {:.2f}, 95% {:.2f} px\n{:.1f}% within 1 px, {:.1f}% lost",
                    moved.medianPx, moved.p95Px, 100 * moved.shareWithin1Px, 100 * moved.shareLost));
  showText(fmt::format("whole picture: {:.1f} dB, {:.2f}% within 4/255", truth.imageDifference.psnrDb,
                       100 * truth.imageDifference.shareWithin4));
}

void drawCamera(Model& model) {
  const auto& cameras = model.loaded.scene->scene.cameras;
  if (!cameras.empty()) {
    ImGui::PushItemWidth(180);
    if (ImGui::BeginCombo("camera", model.view.camera.name.c_str())) {
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::Selectable(cameras[i].name.c_str(), isSameView(cameras[i], model.view.camera))) {
          model.view.camera = cameras[i];
          model.view.sceneCamera = cameras[i].node >= 0 ? std::optional(i) : std::nullopt;
          model.wishes.viewChanged = true;
        }
        ImGui::PopID();
      }
      ImGui::EndCombo();
    }
    ImGui::PopItemWidth();
  }
  if (ImGui::Button("inside the method (I)")) switchInside(model);
  if (ImGui::Button("screenshot (F12)")) model.wishes.screenshot = true;
  ImGui::SameLine();
  if (ImGui::Button("copy command (ctrl-C)")) model.wishes.copyCommand = true;
  if (ImGui::Button(model.recording ? "stop recording (shift-F12)" : "record (shift-F12)"))
    model.wishes.record = true;
  ImGui::SameLine();
  if (ImGui::Button("save session (ctrl-S)")) model.wishes.saveSession = true;
}

void drawPicked(const Model& model) {
  if (!model.picked) return showText("point at something");
  const Picked& picked = *model.picked;
  const app::LoadedScene& scene = *model.frame.request.scene;
  std::string text = fmt::format("pixel {}, {}: ", picked.pixel.x, picked.pixel.y);
  const core::SeenPixel& seen = picked.seen;
  if (seen.isSky())
    text += "the sky";
  else
    text += fmt::format(
        "{}\nat {:.3f} {:.3f} {:.3f}, way {:.3f} m",
        seen.object < scene.scene.instances.size() ? scene.scene.instances[seen.object].name : "?",
        seen.point.x, seen.point.y, seen.point.z, seen.pathLength);
  if (seen.isMirror() && model.frame.geometry &&
      seen.firstReflector < model.frame.geometry->reflectors.size())
    text +=
        fmt::format("\nin {} after {} bounce{}", model.frame.geometry->reflectors[seen.firstReflector].name,
                    seen.bounces, seen.bounces == 1 ? "" : "s");
  if (picked.reflectionPoint)
    text += fmt::format("\nreflected at {:.3f} {:.3f} {:.3f}", picked.reflectionPoint->x,
                        picked.reflectionPoint->y, picked.reflectionPoint->z);
  if (picked.reflectionPoint && seen.bounces == 1)
    text += fmt::format("\noff the mirrored ray by {:.3f} degrees", picked.lawErrorDegrees);
  showText(text);
}

void drawHelp(Model& model) {
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x * 0.5f, ImGui::GetIO().DisplaySize.y * 0.5f),
                          ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  if (ImGui::Begin("Help", &model.view.showHelp,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    if (ImGui::BeginTable("keys", 2)) {
      for (const KeyHelp& row : keyHelp()) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.key);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.meaning);
      }
      ImGui::EndTable();
    }
    showText("Drop a scene, a folder of them, or an .hdr or .exr\nas surroundings, on the window.");
  }
  ImGui::End();
}

std::string describeLoading(const Model& model) {
  const LoadStep step = model.loadStep ? model.loadStep->load() : LoadStep::Waiting;
  const char* what = step == LoadStep::Surroundings ? "surroundings"
                     : step == LoadStep::Drawing    ? "first picture"
                                                    : "scene";
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - model.loadStart;
  return fmt::format("loading {}: {} ... {:.1f} s", model.loadingName, what, passed.count());
}

void drawStatus(const Model& model) {
  std::string text = model.message;
  if (model.isLoading) text = describeLoading(model);
  if (text.empty() && model.preview) text = "ray-traced while the renderer makes ready ...";
  if (text.empty()) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(display.x * 0.5f, display.y - 10), ImGuiCond_Always, ImVec2(0.5f, 1.0f));
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::Begin("status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushTextWrapPos(std::max(200.0f, display.x - 60));
  if (model.isError)
    ImGui::TextColored(ImVec4(1.0f, 0.5f, 0.4f, 1.0f), "%s", text.c_str());
  else
    showText(text);
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void drawMain(Model& model) {
  ImGui::SetNextWindowPos(ImVec2(10, 10), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.8f);
  const std::string title = model.loaded.scene->name + "###catoptric";
  if (ImGui::Begin(title.c_str(), nullptr,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    ImGui::PushTextWrapPos(kPanelWidth);
    drawMethod(model);
    drawCamera(model);
    if (ImGui::CollapsingHeader("against the truth", ImGuiTreeNodeFlags_DefaultOpen)) drawComparison(model);
    if (ImGui::CollapsingHeader("under the mouse")) drawPicked(model);
    if (ImGui::CollapsingHeader("edit", model.view.selected ? ImGuiTreeNodeFlags_DefaultOpen : 0))
      drawSelected(model);
    if (model.loaded.durationS > 0 && ImGui::CollapsingHeader("animation", ImGuiTreeNodeFlags_DefaultOpen))
      drawAnimation(model);
    if (ImGui::CollapsingHeader("time", ImGuiTreeNodeFlags_DefaultOpen)) drawTimes(model);
    if (ImGui::CollapsingHeader("mirrors")) drawReflectors(model);
    if (ImGui::Button("help (H)")) model.view.showHelp = !model.view.showHelp;
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace

void drawPanels(Model& model, const MapPictures& maps) {
  if (model.loaded.scene && model.view.showPanels) {
    drawMain(model);
    drawMaps(model, maps);
    drawInside(model, maps.inside);
  }
  if (model.view.showHelp) drawHelp(model);
  drawStatus(model);
}

}  // namespace catoptric::viewer
