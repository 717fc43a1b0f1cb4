// SPDX-License-Identifier: Apache-2.0
// The loop itself.
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
constexpr double kIdleSeconds = 1.0;   // an idle window still looks after its file and its messages
constexpr int kDrawsAfterEvent = 3;
constexpr double kShowSeconds = 0.15;  // how old the window may be while a frame is drawn

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
  lastLoad_ = options.scene;
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
    askForPreview();
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
  for (const char* what : firsts_)
    options_.sayDetail(fmt::format("{} after {:.0f} ms", what, 1e3 * secondsSince(start_)));
  firsts_.clear();
  if (hasNewPicture_ && !model_.preview && !model_.frame.request.options.withSeen)
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
  if (!hasFrameOfScene()) return 0.5;
  return options_.watch ? 0.5 : kIdleSeconds;
}

bool ViewerLoop::isAtRest() const {
  return secondsSince(lastChange_) >= kRestSeconds;
}

void runViewer(const ViewerOptions& options) {
  keepFreedMemory();
  ViewerLoop(options).run();
}

}  // namespace catoptric::viewer
