// SPDX-License-Identifier: Apache-2.0
// What the user wants done, and what the work behind the window is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "viewer/camera_control.h"
#include "viewer/dropped_files.h"
#include "viewer/inside_panel.h"
#include "viewer/viewer_loop.h"

namespace catoptric::viewer {
namespace {

constexpr double kFinerAfterSeconds = 0.5;  // the next pass of the truth before there is a frame

/// A coarse picture bears longer edges: how many times the error bound of a picture in full, on its own
/// pixels.
double findMovingError(double scale) {
  return scale <= 0.5 ? 4 : scale < 1 ? 2 : 1;
}

}  // namespace

/// Before there is a scene they wait: a failure would end the viewer.
void ViewerLoop::openDropped() {
  if (!model_.loaded.scene) return;
  const std::vector<std::string> files = window_.takeDroppedFiles();
  if (files.empty()) return;
  try {
    const DroppedFiles dropped = sortDroppedFiles(files);
    LoadRequest request = lastLoad_;
    request.keepsCamera = dropped.scenes.empty();
    if (!dropped.environment.empty()) request.environment = dropped.environment;
    if (!dropped.scenes.empty()) {
      request.source = dropped.scenes.front();
      request.mirrors.clear();
      request.noReflectors = false;
      if (dropped.scenes.size() > 1) model_.files = dropped.scenes;
    }
    load(request);
  } catch (const std::exception& error) {
    tellFailure(error);
  }
}

void ViewerLoop::load(LoadRequest request) {
  request.step = loadStep_;
  lastLoad_ = request;
  model_.isLoading = true;
  model_.loadStart = Clock::now();
  model_.loadingName = std::filesystem::path(request.source).filename().string();
  loader_.ask(std::move(request));
}

void ViewerLoop::tell(const std::string& message, bool isError) {
  model_.message = message;
  model_.isError = isError;
  messageTime_ = Clock::now();
}

void ViewerLoop::tellFailure(const std::exception& error) {
  tell(error.what(), true);
  options_.sayDetail(std::string("failed: ") + error.what());
}

void ViewerLoop::grantWishes() {
  Wishes& wishes = model_.wishes;
  if (wishes.close) window_.close();
  if (wishes.load) load(*wishes.load);
  if (model_.loaded.scene) {
    if (wishes.undo || wishes.redo) undoOrRedo(wishes.undo);
    if (wishes.record) switchRecording();
    if (wishes.saveSession) saveSession();
  }
  if (wishes.viewChanged) {
    ++view_;
    lastChange_ = Clock::now();
    if (!oldestUnasked_) oldestUnasked_ = lastChange_;
    model_.truth.reset();
    if (cancelTruth_) *cancelTruth_ = true;
  }
  if (wishes.copyCommand && model_.loaded.scene) {
    const std::string text = commandText();
    window_.copyText(text);
    options_.printLine(text);
    tell("copied: " + text + (model_.view.state.hasEdits() ? " (without the edits)" : ""));
  }
  const bool screenshotWaits = wishes.screenshot && !isFrameSettled();
  if (wishes.screenshot && !screenshotWaits) writeScreenshot();
  wishes = Wishes{};
  wishes.screenshot = screenshotWaits;
}

std::vector<std::string> ViewerLoop::makeSceneWords() const {
  std::vector<std::string> words = model_.sceneOptions;
  if (model_.view.state.timeS) words.push_back(fmt::format("--time={}", *model_.view.state.timeS));
  if (!model_.loaded.scene->animation.empty())
    words.push_back("--animation=" + model_.loaded.scene->animation);
  return words;
}

void ViewerLoop::writeScreenshot() {
  std::string file;
  for (int number = 1; file.empty() || std::filesystem::exists(file); ++number)
    file = fmt::format("{}-{:04}.png", model_.loaded.scene->name, number);
  try {
    core::writeFileAtomically(
        file, std::span<const std::byte>(core::encodePng(composeShownPicture(model_), commandText())));
    options_.say("wrote " + file);
    tell("wrote " + file);
  } catch (const core::Error& error) {
    tell(error.what(), true);
  }
}

FrameRequest ViewerLoop::makeFrameRequest() const {
  FrameRequest request;
  request.scene = model_.loaded.scene;
  request.state = model_.view.state;
  request.camera = model_.view.camera;
  request.sceneCamera = model_.view.sceneCamera;
  request.options = model_.frameOptions(windowPx_);
  request.exposure = model_.view.exposure;
  request.view = view_;
  request.changed = oldestUnasked_.value_or(lastChange_);
  return request;
}

void ViewerLoop::askForFrame() {
  if (!model_.loaded.scene || windowPx_.x == 0) return;
  const bool isFirst = !model_.frame.frame;
  const bool isRecording = model_.recording.has_value();
  const bool inFull = (isAtRest() && !isFirst) || isRecording;  // the first picture is coarse, but soon there
  const bool withSeen = inFull && !isRecording;
  FrameRequest request = makeFrameRequest();
  request.scale = inFull ? 1.0 : moving_.scale();
  request.options.maxErrorPx *= inFull ? 1.0 : findMovingError(request.scale);
  request.options.withSeen = withSeen;
  request.options.isPassing = !inFull;
  request.options.drawsSeen = true;  // the first picture in full has nothing to compile after the coarse one
  request.options.widthPx = std::max(1, int(request.options.widthPx * request.scale));
  request.options.heightPx = std::max(1, int(request.options.heightPx * request.scale));
  if (asked_.view == request.view && asked_.options.withSeen == withSeen) return;
  // The next one when this one is there, of the view as it is then.
  if ((!inFull || isRecording) && drawer_.isBusy()) return;
  if (isRecording)
    request.recordFile = fmt::format("{}/{:04}.png", model_.recording->folder, ++model_.recording->frames);
  asked_ = request;
  oldestUnasked_.reset();
  drawer_.ask(std::move(request));
}

/// Rays need no shaders, which are compiled while they are traced; the eye may move meanwhile. Finer ones
/// only where compiling takes long, since they slow it down.
void ViewerLoop::askForPreview() {
  if (!model_.loaded.scene || windowPx_.x == 0 || hasFrameOfScene() || tracer_.isBusy()) return;
  FrameRequest request = makeFrameRequest();
  if (request.options.method == renderer::Method::RayTrace || request.scene == withoutPreview_) return;
  const bool isNext =
      model_.preview && model_.preview->scene == request.scene && model_.preview->view == view_;
  const int pass = isNext ? model_.preview->pass + 1 : 0;
  if (pass >= kPreviewPasses || (isNext && secondsSince(previewTime_) < kFinerAfterSeconds)) return;
  tracer_.ask(
      {{.request = std::move(request), .frame = nullptr, .geometry = nullptr, .picture = {}}, nullptr, pass});
}

void ViewerLoop::askForTruth() {
  if (model_.view.comparison == Comparison::None || !isAtRest() || !isFrameSettled() || tracer_.isBusy())
    return;
  const int pass = model_.truthIsCurrent() ? model_.truth->pass + 1 : 0;
  if (pass >= kTruthPasses) return;
  cancelTruth_ = std::make_shared<std::atomic<bool>>(false);
  tracer_.ask({model_.frame, cancelTruth_, pass});
  model_.isTracing = true;
}

/// Of the frame at rest that the drawer has drawn last.
void ViewerLoop::askForElsewhere() {
  ViewState& view = model_.view;
  if (!view.insideOf || !model_.view.showPanels || !isFrameSettled() || drawer_.isBusy()) return;
  if (model_.picked && !model_.picked->seen.isSky() && model_.picked->seen.firstReflector == *view.insideOf)
    view.marks.point = dvec3(model_.picked->seen.point);
  FrameRequest request = model_.frame.request;
  request.recordFile.clear();
  request.elsewhere =
      ElsewhereRequest{view.elsewhere, {*view.insideOf, view.marks, view.elsewherePx.x, view.elsewherePx.y}};
  if (askedElsewhere_.elsewhere && askedElsewhere_.view == request.view &&
      isSameView(askedElsewhere_.elsewhere->camera, view.elsewhere) &&
      askedElsewhere_.elsewhere->options == request.elsewhere->options)
    return;
  askedElsewhere_ = request;
  drawer_.ask(std::move(request));
}

void ViewerLoop::askForMaps() {
  if (!model_.view.mapsOf || !model_.view.showPanels || mapper_.isBusy()) return;
  const MapsRequest request{model_.geometry, model_.view.camera.eye, *model_.view.mapsOf};
  if (askedMaps_.geometry == request.geometry && askedMaps_.eye == request.eye &&
      askedMaps_.reflector == request.reflector)
    return;
  askedMaps_ = request;
  mapper_.ask(request);
}

}  // namespace catoptric::viewer
