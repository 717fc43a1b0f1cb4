// SPDX-License-Identifier: Apache-2.0
#include "viewer/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/camera_control.h"
#include "viewer/inside_panel.h"
#include "viewer/picking.h"

namespace catoptric::viewer {
namespace {

constexpr float kGrabPx = 8;  // how near to the split line a press takes it

void nextMethod(Model& model, int step) {
  const std::size_t count = model.variants.size();
  model.view.variant = (model.view.variant + count + std::size_t(step + int(count))) % count;
  model.wishes.viewChanged = true;
}

void nextFile(Model& model, int step) {
  if (model.files.empty() || model.isLoading) return;
  const auto at = std::find(model.files.begin(), model.files.end(), model.loaded.request.source);
  const int count = int(model.files.size());
  const int index = at == model.files.end() ? 0 : (int(at - model.files.begin()) + step + count) % count;
  LoadRequest request;
  request.source = model.files[std::size_t(index)];
  request.environment = model.loaded.request.environment;
  model.wishes.load = request;
}

void setCamera(Model& model, const scene::Camera& camera) {
  if (isSameView(model.view.camera, camera)) return;
  model.view.camera = camera;
  model.view.sceneCamera.reset();
  model.wishes.viewChanged = true;
}

/// Keys that move the camera.
void handleViewKey(Model& model, int key) {
  const scene::Camera& camera = model.view.camera;
  const core::Box& bounds = model.loaded.scene->geometry.bounds;
  switch (key) {
    case GLFW_KEY_F:
      return setCamera(model, frameAll(camera, bounds));
    case GLFW_KEY_R:
      return setCamera(model, model.view.firstCamera);
    case GLFW_KEY_1:
      return setCamera(model, frameFrom(Side::Front, camera, bounds));
    case GLFW_KEY_3:
      return setCamera(model, frameFrom(Side::Right, camera, bounds));
    case GLFW_KEY_7:
      return setCamera(model, frameFrom(Side::Top, camera, bounds));
    default:
      return;
  }
}

/// Keys that choose what the picture is compared with.
void handleComparisonKey(ViewState& view, int key) {
  if (key == GLFW_KEY_S)
    view.comparison = view.comparison == Comparison::Split ? Comparison::None : Comparison::Split;
  if (key == GLFW_KEY_D)
    view.comparison = view.comparison == Comparison::Difference     ? Comparison::Displacement
                      : view.comparison == Comparison::Displacement ? Comparison::None
                                                                    : Comparison::Difference;
}

void changeBounces(Model& model, int step) {
  model.view.frame.bounces = std::clamp(model.view.frame.bounces + step, 0, 16);
  model.wishes.viewChanged = true;
}

void handleControlKey(Wishes& wishes, const KeyPress& press) {
  if (press.key == GLFW_KEY_C) wishes.copyCommand = true;
  if (press.key == GLFW_KEY_S) wishes.saveSession = true;
  if (press.key == GLFW_KEY_Z) (press.shift ? wishes.redo : wishes.undo) = true;
  if (press.key == GLFW_KEY_Y) wishes.redo = true;
}

void handleKey(Model& model, const KeyPress& press) {
  ViewState& view = model.view;
  Wishes& wishes = model.wishes;
  if (press.key == GLFW_KEY_ESCAPE) wishes.close = true;
  if (press.control) return handleControlKey(wishes, press);
  if (press.key == GLFW_KEY_H || (press.shift && press.key == GLFW_KEY_SLASH)) view.showHelp = !view.showHelp;
  if (press.key == GLFW_KEY_I && model.loaded.scene) switchInside(model);
  if (press.key == GLFW_KEY_P) view.showPanels = !view.showPanels;
  if (press.key == GLFW_KEY_M) nextMethod(model, press.shift ? -1 : 1);
  if (press.key == GLFW_KEY_PAGE_DOWN) nextFile(model, 1);
  if (press.key == GLFW_KEY_PAGE_UP) nextFile(model, -1);
  if (press.key == GLFW_KEY_F12) (press.shift ? wishes.record : wishes.screenshot) = true;
  if (press.key == GLFW_KEY_SPACE && model.loaded.durationS > 0) view.isPlaying = !view.isPlaying;
  if (press.key == GLFW_KEY_LEFT_BRACKET) changeBounces(model, -1);
  if (press.key == GLFW_KEY_RIGHT_BRACKET) changeBounces(model, 1);
  handleComparisonKey(view, press.key);
  if (model.loaded.scene) handleViewKey(model, press.key);
}

/// True while the line is held.
bool dragSplit(Model& model, const ivec2& windowPx) {
  static bool isHeld = false;
  const ImGuiIO& io = ImGui::GetIO();
  if (model.view.comparison != Comparison::Split || !ImGui::IsMouseDown(0)) return isHeld = false;
  const float line = model.view.split * float(windowPx.x);
  if (ImGui::IsMouseClicked(0) && std::abs(io.MousePos.x - line) <= kGrabPx) isHeld = true;
  if (isHeld) model.view.split = std::clamp(io.MousePos.x / float(std::max(windowPx.x, 1)), 0.0f, 1.0f);
  return isHeld;
}

/// Control and the left button move the thing under the mouse. True while one is held.
bool dragObject(Model& model, const dvec2& at, const ivec2& windowPx) {
  const ImGuiIO& io = ImGui::GetIO();
  SceneState& state = model.view.state;
  if (io.KeyCtrl && ImGui::IsMouseClicked(0)) {
    const double aspect = double(windowPx.x) / std::max(windowPx.y, 1);
    const auto grabbed = findObjectAt(*model.geometry, model.view.camera, at, aspect);
    model.view.selected.reset();
    if (!grabbed) return false;
    model.view.selected = Selected{grabbed->instance, grabbed->material};
    model.drag = Drag{grabbed->instance, grabbed->point, state.shiftOf(grabbed->instance)};
  }
  if (!model.drag) return false;
  Drag& drag = *model.drag;
  if (!ImGui::IsMouseDown(0)) {
    model.edits.add(ShiftEdit{drag.instance, drag.before, state.shiftOf(drag.instance)});
    model.drag.reset();
    return true;
  }
  const dvec3 move =
      findDrag(model.view.camera, drag.point, dvec2(io.MouseDelta.x, io.MouseDelta.y), windowPx.y);
  if (move == dvec3(0)) return true;
  drag.point += move;
  state.setShift(drag.instance, state.shiftOf(drag.instance) + move);
  model.wishes.viewChanged = true;
  return true;
}

void handleMouse(Model& model, const ivec2& windowPx) {
  const ImGuiIO& io = ImGui::GetIO();
  const dvec2 at(io.MousePos.x / std::max(windowPx.x, 1), io.MousePos.y / std::max(windowPx.y, 1));
  model.picked = pick(model.frame, at);
  if (dragSplit(model, windowPx) || dragObject(model, at, windowPx)) return;
  scene::Camera camera = model.view.camera;
  const dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsMouseDoubleClicked(0) && model.picked && !model.picked->seen.isSky()) {
    const Picked& picked = *model.picked;
    setPivot(camera, picked.reflectionPoint.value_or(dvec3(picked.seen.point)));
  } else if (moved != dvec2(0) && !ImGui::IsMouseClicked(0) &&
             !ImGui::IsMouseClicked(2)) {  // not before the press
    if (ImGui::IsMouseDown(2) || (ImGui::IsMouseDown(0) && io.KeyShift))
      pan(camera, moved, windowPx.y);
    else if (ImGui::IsMouseDown(0))
      orbit(camera, moved);
  }
  if (io.MouseWheel != 0) zoom(camera, io.MouseWheel);
  if (ImGui::IsMouseClicked(1) && model.picked && model.picked->seen.isMirror())
    model.view.mapsOf = model.picked->seen.firstReflector;
  setCamera(model, camera);
}

}  // namespace

void handleInput(Model& model, std::span<const KeyPress> keys, const ivec2& windowPx) {
  const ImGuiIO& io = ImGui::GetIO();
  for (const KeyPress& press : keys) {
    if (press.control && press.key == GLFW_KEY_Q) model.wishes.close = true;
    if (!io.WantTextInput) handleKey(model, press);  // else the keys are for the number that is being typed
  }
  if ((io.WantCaptureMouse && !model.drag) || !model.loaded.scene || !ImGui::IsMousePosValid())
    model.picked.reset();
  else
    handleMouse(model, windowPx);
}

std::span<const KeyHelp> keyHelp() {
  static constexpr std::array<KeyHelp, 23> kHelp{{{"left drag", "orbit"},
                                                  {"middle or shift-left drag", "pan"},
                                                  {"wheel", "zoom"},
                                                  {"double click", "set the pivot"},
                                                  {"right click", "explosion maps of the mirror"},
                                                  {"ctrl-click, ctrl-left drag", "pick, move an object"},
                                                  {"ctrl-Z, ctrl-shift-Z", "undo, redo"},
                                                  {"space", "play, pause"},
                                                  {"I", "inside the method: a second camera"},
                                                  {"M, shift-M", "next, previous method"},
                                                  {"S", "split line against the ray-traced truth"},
                                                  {"D", "difference, displacement, off"},
                                                  {"[ ]", "fewer, more bounces"},
                                                  {"F", "frame all"},
                                                  {"R", "reset the camera"},
                                                  {"1, 3, 7", "from the front, the right, above"},
                                                  {"page up, down", "other file of the folder"},
                                                  {"F12", "screenshot"},
                                                  {"shift-F12", "record frames, stop"},
                                                  {"ctrl-S", "save the session"},
                                                  {"ctrl-C", "copy the command line"},
                                                  {"P", "panels on and off"},
                                                  {"H or ?, Esc or ctrl-Q", "this help, quit"}}};
  return kHelp;
}

}  // namespace catoptric::viewer
