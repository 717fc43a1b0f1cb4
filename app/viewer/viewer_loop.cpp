// SPDX-License-Identifier: Apache-2.0
// The loop itself, and what comes out of the work behind the window.
#include "viewer/viewer_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "catoptric/core/error.h"
#include "viewer/camera_control.h"
#include "viewer/input.h"

namespace catoptric::viewer {
namespace {

constexpr double kRestSeconds = 0.25;  // after this long without a change the view is at rest
constexpr double kMessageSeconds = 5.0;
constexpr double kIdleSeconds = 1.0;  // an idle window still looks after its file and its messages
constexpr int kDrawsAfterEvent = 3;
constexpr double kShowSeconds = 0.15;  // how old the window may be while a frame is drawn

double secondsSince(ViewerLoop::Clock::time_point start) {
  return std::chrono::duration<double>(ViewerLoop::Clock::now() - start).count();
}

/// Then edits, which go by number, still mean the same.
bool hasSameThings(const scene::Scene& a, const scene::Scene& b) {
  const auto isSameName = [](const auto& x, const auto& y) { return x.name == y.name; };
  return std::equal(a.instances.begin(), a.instances.end(), b.instances.begin(), b.instances.end(),
                    isSameName) &&
         std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                    isSameName);
}

/// Loading begins before there is a window; but if none can be opened, nobody should have to end standard
/// input first.
std::optional<LoadRequest> findEarlyRequest(const ViewerOptions& options,
                                            const std::shared_ptr<std::atomic<LoadStep>>& step) {
  if (options.scene.source == "-") return std::nullopt;
  LoadRequest request = options.scene;
  request.step = step;
  return request;
}

/// A frame's arrays are as large as the last one's: memory that goes back to the system costs a page fault
/// for each page of each frame.
void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kLargestArrayBytes = 32 << 20;  // more than this glibc does not allow
  mallopt(M_MMAP_THRESHOLD, kLargestArrayBytes);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace

ViewerLoop::ViewerLoop(const ViewerOptions& options)
    : options_(options),
      loader_([&options] { return options.load; }, Window::wake, findEarlyRequest(options, loadStep_)),
      drawer_(makeFrameWork, Window::wake),
      tracer_(makeTruthWork, Window::wake),
      mapper_(makeMapsWork, Window::wake),
      window_("catoptric", options.frame.widthPx, options.frame.heightPx) {
  model_.variants = options.variants;
  model_.files = options.files;
  model_.sceneOptions = options.sceneOptions;
  model_.view.variant = options.variant;
  model_.view.frame = options.frame;
  model_.view.exposure = options.exposure;
  model_.loadStep = loadStep_;
  model_.loadStart = start_;
  model_.loadingName = std::filesystem::path(options.scene.source).filename().string();
  model_.isLoading = true;
  window_.beforeDisplayIsLost([this] { rescueEdits(); });
  if (options.scene.source == "-") load(options.scene);
}

void ViewerLoop::run() {
  while (!window_.shouldClose()) {
    if (window_.waitForEvents(drawsLeft_ > 0 ? 0.0 : waitSeconds()) && drawsLeft_ == 0)
      drawsLeft_ = kDrawsAfterEvent;
    drawsLeft_ = std::max(0, drawsLeft_ - 1);
    takeResults();
    openDropped();
    const ivec2 size = window_.sizePx();
    if (size != windowPx_ && size.x > 0 && size.y > 0) {
      windowPx_ = size;
      model_.wishes.viewChanged = true;
    }
    window_.beginFrame();
    drawPicture(model_, pictures_, windowPx_);
    drawPanels(model_, maps_);
    handleInput(model_, window_.takeKeys(), windowPx_);
    advanceTime();
    grantWishes();
    askForFrame();  // before the window is drawn: the next frame is drawn meanwhile
    askForTruth();
    askForMaps();
    askForElsewhere();
    show();
    if (options_.watch && watched_.hasChanged() && !model_.isLoading) {
      LoadRequest again = model_.loaded.request;
      again.keepsCamera = true;
      load(again);
    }
  }
}

void ViewerLoop::show() {
  if (!isWorthShowing()) return window_.dropFrame();
  try {
    window_.endFrame();
  } catch (const core::Error&) {
    rescueEdits();
    throw;
  }
  lastShown_ = Clock::now();
  if (hasNewPicture_ && !model_.frame.request.options.withSeen)
    options_.sayDetail(fmt::format("moving: {}x{}, {:.0f} ms, {:.0f} ms after the input",
                                   model_.frame.picture.width(), model_.frame.picture.height(),
                                   model_.frame.wholeMs, 1e3 * secondsSince(model_.frame.request.changed)));
  hasNewPicture_ = false;
}

/// A mouse sends a hundred moves a second; drawing the window for each would take a core from the frame that
/// they ask for.
bool ViewerLoop::isWorthShowing() const {
  return hasNewPicture_ || !drawer_.isBusy() || isAtRest() || secondsSince(lastShown_) > kShowSeconds;
}

double ViewerLoop::waitSeconds() const {
  if (model_.view.isPlaying && !model_.isDrawing) return 0.005;
  if (!isAtRest() || model_.wishes.screenshot) return 0.05;
  if (model_.isLoading) return 0.1;  // it is shown for how long
  return options_.watch ? 0.5 : kIdleSeconds;
}

void ViewerLoop::takeResults() {
  // Failures of the first scene end the viewer; later ones are shown, and what was there stays.
  const auto attempt = [&](const auto& take) {
    try {
      take();
    } catch (const std::exception& error) {
      if (!model_.loaded.scene) throw;
      tell(error.what(), true);
      options_.sayDetail(std::string("failed: ") + error.what());
    }
  };
  attempt([&] {
    if (auto result = loader_.take()) takeScene(std::move(*result));
  });
  attempt([&] { takeFrameOrTryAgain(); });
  attempt([&] {
    if (auto result = tracer_.take()) takeTruth(std::move(*result));
  });
  attempt([&] {
    if (auto result = mapper_.take()) takeMaps(std::move(*result));
  });
  model_.isLoading = loader_.isBusy();
  model_.isDrawing = drawer_.isBusy();
  model_.isTracing = tracer_.isBusy();
  if (!model_.message.empty() && !model_.isError && secondsSince(messageTime_) > kMessageSeconds)
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
  if (!model_.frame.frame)
    options_.sayDetail(fmt::format("first picture after {:.0f} ms", 1e3 * secondsSince(start_)));
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
  if (isFrameSettled() && !isFirstInFull_)
    options_.sayDetail(fmt::format("first picture in full after {:.0f} ms", 1e3 * secondsSince(start_)));
  isFirstInFull_ = isFirstInFull_ || isFrameSettled();
  if (isFrameSettled())
    options_.sayDetail(fmt::format("settled: {}, {}x{}, {:.0f} ms", model_.variants[model_.view.variant].name,
                                   model_.frame.picture.width(), model_.frame.picture.height(),
                                   model_.frame.wholeMs));
}

void ViewerLoop::takeTruth(TruthResult result) {
  if (result.view != view_) return;
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

bool ViewerLoop::isAtRest() const {
  return secondsSince(lastChange_) >= kRestSeconds;
}

void runViewer(const ViewerOptions& options) {
  keepFreedMemory();
  ViewerLoop(options).run();
}

}  // namespace catoptric::viewer
