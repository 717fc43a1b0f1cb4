// SPDX-License-Identifier: Apache-2.0
// What comes out of the work behind the window: scenes, frames, passes of the truth, maps; and what of it
// fails.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "catoptric/core/error.h"
#include "viewer/camera_control.h"
#include "viewer/viewer_loop.h"

namespace catoptric::viewer {
namespace {

constexpr double kMessageSeconds = 5.0, kErrorSeconds = 20.0;  // how long they are shown

/// Then edits, which go by number, still mean the same.
bool hasSameThings(const scene::Scene& a, const scene::Scene& b) {
  const auto isSameName = [](const auto& x, const auto& y) { return x.name == y.name; };
  return std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    isSameName) &&
         std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                    isSameName);
}

}  // namespace

void ViewerLoop::takeResults() {
  // Failures of the first scene end the viewer; later ones are shown, and what was there stays.
  const auto attempt = [&](const auto& take) {
    try {
      take();
    } catch (const std::exception& error) {
      if (!model_.loaded.scene) throw;
      tellFailure(error);
    }
  };
  attempt([&] { takeSceneOrStay(); });
  attempt([&] { takeFrameOrTryAgain(); });
  attempt([&] {
    try {
      if (auto result = tracer_.take()) takeTruth(std::move(*result));
    } catch (...) {
      withoutPreview_ = model_.loaded.scene;
      throw;
    }
  });
  attempt([&] {
    if (auto result = mapper_.take()) takeMaps(std::move(*result));
  });
  model_.isLoading = loader_.isBusy();
  model_.isDrawing = drawer_.isBusy();
  model_.isTracing = tracer_.isBusy();
  if (!model_.message.empty() &&
      secondsSince(messageTime_) > (model_.isError ? kErrorSeconds : kMessageSeconds))
    model_.message.clear();
}

/// The drawer's context may be lost and made anew; twice in a row is a failure like any other.
void ViewerLoop::takeFrameOrTryAgain() {
  try {
    if (auto result = drawer_.take()) takeFrame(std::move(*result));
  } catch (const std::exception& error) {
    const auto* known = dynamic_cast<const core::Error*>(&error);
    if (known != nullptr && known->code() == "gl.lost" && !hasLostContext_) {
      hasLostContext_ = true;
      if (model_.recording && !asked_.recordFile.empty()) --model_.recording->frames;
      asked_ = {};
      return options_.sayDetail(error.what());
    }
    model_.recording.reset();
    model_.view.isPlaying = false;
    throw;
  }
}

/// A camera of the scene that moves takes the eye with it.
void ViewerLoop::useCameraOf(const LoadResult& result) {
  model_.view.camera = model_.view.firstCamera = result.camera;
  model_.view.sceneCamera.reset();
  const auto& cameras = result.scene->scene.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].node >= 0 && isSameView(cameras[i], result.camera)) model_.view.sceneCamera = i;
}

void ViewerLoop::takeSceneOrStay() {
  try {
    if (auto result = loader_.take()) takeScene(std::move(*result));
  } catch (...) {
    lastLoad_ = model_.loaded.request;
    throw;
  }
}

void ViewerLoop::takeScene(LoadResult result) {
  const bool isSubset = !result.request.mirrors.empty() || result.request.noReflectors;
  if (isSubset && model_.loaded.scene && model_.loaded.request.source == result.request.source)
    result.reflectors = model_.loaded.reflectors;
  const bool isFirst = !model_.loaded.scene;
  if (isFirst && options_.session) checkSession(*options_.session, result.scene->scene);
  const bool isSame = !isFirst && result.request.keepsCamera &&
                      hasSameThings(model_.loaded.scene->scene, result.scene->scene);
  if (!result.request.keepsCamera || isFirst) useCameraOf(result);
  model_.drag.reset();
  if (!isSame) {
    model_.edits.clear();
    model_.view.selected.reset();
    model_.view.state = {};
    if (result.timeS) model_.view.state.timeS = result.timeS;
    if (!isFirst) model_.view.isPlaying = false;
  }
  model_.loaded = std::move(result);
  const std::string& surroundings = model_.loaded.request.environment;
  if (!surroundings.empty() && std::find(model_.environments.begin(), model_.environments.end(),
                                         surroundings) == model_.environments.end())
    model_.environments.push_back(surroundings);
  model_.geometry = geometryOf(model_.loaded.scene);
  model_.geometryState = {};
  if (isFirst && options_.session) restoreSession(*options_.session, model_.view);
  model_.view.mapsOf.reset();
  model_.view.insideOf.reset();
  model_.wishes.viewChanged = true;
  model_.message.clear();
  if (options_.watch && !model_.loaded.scene->isBuiltIn) watched_.watch(model_.loaded.request.source);
  window_.setTitle(model_.loaded.scene->name + " - catoptric");
}

void ViewerLoop::takeFrame(FrameResult result) {
  if (result.request.elsewhere) {
    maps_.inside.set(result.picture);
    drawsLeft_ = std::max(drawsLeft_, 1);
    return options_.sayDetail("from elsewhere");
  }
  if (result.request.scene != model_.loaded.scene) return;  // another one has come meanwhile
  if (!model_.frame.frame) firsts_.push_back("first frame");
  if (std::exchange(model_.preview, std::nullopt) && model_.view.comparison == Comparison::None)
    tracer_.ask({});  // a scene takes memory once more for its rays
  hasLostContext_ = false;
  moving_.learn(result.request.scale, result.wholeMs);
  model_.history.add(result);
  if (result.geometry) {
    model_.geometry = result.geometry;
    model_.geometryState = result.request.state;
  }
  if (result.request.sceneCamera && result.request.sceneCamera == model_.view.sceneCamera)
    model_.view.camera = result.request.camera;
  pictures_.method.set(result.picture);
  hasNewPicture_ = true;
  model_.frame = std::move(result);
  drawsLeft_ = std::max(drawsLeft_, 1);
  if (isFrameSettled() && !isFirstInFull_) firsts_.push_back("first frame in full");
  isFirstInFull_ = isFirstInFull_ || isFrameSettled();
  if (isFrameSettled())
    options_.sayDetail(fmt::format("settled: {}, {}x{}, {:.0f} ms", model_.variants[model_.view.variant].name,
                                   model_.frame.picture.width(), model_.frame.picture.height(),
                                   model_.frame.wholeMs));
}

/// The picture before the first frame of a scene, of the view as it was a moment ago.
void ViewerLoop::takePreview(TruthResult result) {
  if (result.scene != model_.loaded.scene || hasFrameOfScene()) return;
  if (!model_.frame.frame && !model_.preview) firsts_.push_back("first picture, ray-traced,");
  pictures_.method.set(result.picture);
  hasNewPicture_ = true;
  drawsLeft_ = std::max(drawsLeft_, 1);
  previewTime_ = Clock::now();
  model_.preview = std::move(result);
}

void ViewerLoop::takeTruth(TruthResult result) {
  if (result.isPreview) return takePreview(std::move(result));
  if (result.scene != model_.loaded.scene || result.view != view_) return;
  pictures_.truth.set(result.picture);
  if (result.difference.isEmpty() && model_.truthIsCurrent()) {  // a later pass: figures stay
    result.difference = std::move(model_.truth->difference);
    result.displacement = std::move(model_.truth->displacement);
    result.objectPixels = model_.truth->objectPixels;
    result.mirrorPixels = model_.truth->mirrorPixels;
    result.imageDifference = model_.truth->imageDifference;
  } else {
    pictures_.difference.set(result.difference);
    pictures_.displacement.set(result.displacement);
  }
  options_.sayDetail(fmt::format("truth: pass {} of {}", result.pass + 1, kTruthPasses));
  model_.truth = std::move(result);
}

void ViewerLoop::takeMaps(MapsResult result) {
  maps_.nearMap.setExact(result.nearMap);
  maps_.farMap.setExact(result.farMap);
  maps_.hiddenMap.setExact(result.hiddenMap);
  model_.maps = std::move(result);
}

}  // namespace catoptric::viewer
