// SPDX-License-Identifier: Apache-2.0
// The loop: wait for an event or for work that is done, take results, let the user act, draw, ask for what is
// missing. Nothing in here takes long.
#include "viewer/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "viewer/command_text.h"
#include "viewer/input.h"
#include "viewer/panels.h"
#include "viewer/picture_view.h"
#include "viewer/resolution.h"
#include "viewer/watched_file.h"
#include "viewer/window.h"

namespace catoptric::viewer {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kRestSeconds = 0.25;  // after this long without a change the view is at rest
constexpr double kMessageSeconds = 5.0;
constexpr double kIdleSeconds = 1.0;  // an idle window still looks after its file and its messages
constexpr int kDrawsAfterEvent = 3;   // ImGui reacts to an event a frame or two later

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool isEnvironmentFile(const std::string& file) {
  return file.ends_with(".hdr") || file.ends_with(".exr") || file.ends_with(".HDR") || file.ends_with(".EXR");
}

class Viewer {
 public:
  explicit Viewer(const ViewerOptions& options);
  /// A pass of the truth that nobody will see need not be finished.
  ~Viewer() {
    if (cancelTruth_) *cancelTruth_ = true;
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  void run();

 private:
  void takeResults();
  void takeScene(LoadResult result);
  void takeFrame(FrameResult result);
  void takeTruth(TruthResult result);
  void takeMaps(MapsResult result);
  void openDropped();
  void grantWishes();
  void writeScreenshot();
  [[nodiscard]] std::string commandText() const {
    return makeCommandText(model_.loaded.request, model_.view.camera, model_.frameOptions(windowPx_),
                           model_.view.exposure, model_.sceneOptions);
  }
  void askForFrame();
  void askForTruth();
  void askForMaps();
  void load(const LoadRequest& request);
  void tell(const std::string& message, bool isError = false);
  [[nodiscard]] double waitSeconds() const;
  [[nodiscard]] bool isAtRest() const { return secondsSince(lastChange_) >= kRestSeconds; }
  /// True when the frame shown is the current view in full.
  [[nodiscard]] bool isFrameSettled() const {
    return model_.frame.frame && model_.frame.request.view == view_ && model_.frame.request.options.withSeen;
  }

  const ViewerOptions& options_;
  Clock::time_point start_ = Clock::now();
  // Workers outlive the window: it is gone at once when it is closed, however long the work in hand takes.
  LoadWorker loader_;
  FrameWorker drawer_;
  TruthWorker tracer_;
  MapsWorker mapper_;
  Window window_;
  ShownPictures pictures_;
  MapPictures maps_;
  Model model_;
  MovingResolution moving_;
  WatchedFile watched_;
  Clock::time_point lastChange_{}, messageTime_{};
  std::uint64_t view_ = 1;
  FrameRequest asked_;
  MapsRequest askedMaps_;
  std::shared_ptr<std::atomic<bool>> cancelTruth_;  ///< of the pass in hand
  ivec2 windowPx_{0};
  int drawsLeft_ = kDrawsAfterEvent;
};

Viewer::Viewer(const ViewerOptions& options)
    : options_(options),
      loader_([&options] { return options.load; }, Window::wake),
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
  load(options.scene);
}

void Viewer::run() {
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
    window_.endFrame();
    grantWishes();
    askForFrame();
    askForTruth();
    askForMaps();
    if (options_.watch && watched_.hasChanged() && !model_.isLoading) {
      LoadRequest again = model_.loaded.request;
      again.keepsCamera = true;
      load(again);
    }
  }
}

double Viewer::waitSeconds() const {
  if (!isAtRest() || model_.wishes.screenshot) return 0.05;
  return options_.watch ? 0.5 : kIdleSeconds;
}

void Viewer::takeResults() {
  // Failures of the first scene end the viewer; later ones are shown, and what was there stays.
  const auto attempt = [&](const auto& take) {
    try {
      take();
    } catch (const std::exception& error) {
      if (!model_.loaded.scene) throw;
      tell(error.what(), true);
    }
  };
  attempt([&] {
    if (auto result = loader_.take()) takeScene(std::move(*result));
  });
  attempt([&] {
    if (auto result = drawer_.take()) takeFrame(std::move(*result));
  });
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

void Viewer::takeScene(LoadResult result) {
  const bool isSubset = !result.request.mirrors.empty() || result.request.noReflectors;
  if (isSubset && model_.loaded.scene && model_.loaded.request.source == result.request.source)
    result.reflectors = model_.loaded.reflectors;
  if (!result.request.keepsCamera || !model_.loaded.scene)
    model_.view.camera = model_.view.firstCamera = result.camera;
  model_.loaded = std::move(result);
  model_.view.mapsOf.reset();
  model_.wishes.viewChanged = true;
  model_.message.clear();
  if (options_.watch && !model_.loaded.scene->isBuiltIn) watched_.watch(model_.loaded.request.source);
  window_.setTitle(model_.loaded.scene->name + " - catoptric");
}

void Viewer::takeFrame(FrameResult result) {
  if (!model_.frame.frame)
    options_.sayDetail(fmt::format("first picture after {:.0f} ms", 1e3 * secondsSince(start_)));
  moving_.learn(result.request.scale, result.wholeMs);
  model_.history.add(result);
  pictures_.method.set(result.picture);
  model_.frame = std::move(result);
  drawsLeft_ = std::max(drawsLeft_, 1);
  if (isFrameSettled())
    options_.sayDetail(fmt::format("settled: {}, {}x{}, {:.0f} ms", model_.variants[model_.view.variant].name,
                                   model_.frame.picture.width(), model_.frame.picture.height(),
                                   model_.frame.wholeMs));
}

void Viewer::takeTruth(TruthResult result) {
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

void Viewer::takeMaps(MapsResult result) {
  maps_.nearMap.setExact(result.nearMap);
  maps_.farMap.setExact(result.farMap);
  maps_.hiddenMap.setExact(result.hiddenMap);
  model_.maps = std::move(result);
}

void Viewer::openDropped() {
  for (const std::string& file : window_.takeDroppedFiles()) {
    LoadRequest request = model_.loaded.request;
    request.keepsCamera = isEnvironmentFile(file);
    if (request.keepsCamera) {
      request.environment = file;
    } else {
      request.source = file;
      request.mirrors.clear();
      request.noReflectors = false;
    }
    load(request);
  }
}

void Viewer::load(const LoadRequest& request) {
  loader_.ask(request);
  model_.isLoading = true;
}

void Viewer::tell(const std::string& message, bool isError) {
  model_.message = message;
  model_.isError = isError;
  messageTime_ = Clock::now();
}

void Viewer::grantWishes() {
  Wishes& wishes = model_.wishes;
  if (wishes.close) window_.close();
  if (wishes.load) load(*wishes.load);
  if (wishes.viewChanged) {
    ++view_;
    lastChange_ = Clock::now();
    model_.truth.reset();
    if (cancelTruth_) *cancelTruth_ = true;
  }
  if (wishes.copyCommand && model_.loaded.scene) {
    const std::string text = commandText();
    window_.copyText(text);
    options_.printLine(text);
    tell("copied: " + text);
  }
  const bool screenshotWaits = wishes.screenshot && !isFrameSettled();
  if (wishes.screenshot && !screenshotWaits) writeScreenshot();
  wishes = Wishes{};
  wishes.screenshot = screenshotWaits;
}

void Viewer::writeScreenshot() {
  std::string file;
  for (int number = 1; file.empty() || std::filesystem::exists(file); ++number)
    file = fmt::format("{}-{:04}.png", model_.loaded.scene->name, number);
  try {
    core::writeFileAtomically(file, std::span<const std::byte>(core::encodePng(composeShownPicture(model_), commandText())));
    options_.say("wrote " + file);
    tell("wrote " + file);
  } catch (const core::Error& error) {
    tell(error.what(), true);
  }
}

void Viewer::askForFrame() {
  if (!model_.loaded.scene || windowPx_.x == 0) return;
  const bool isFirst = !model_.frame.frame;
  const bool inFull = isFirst || isAtRest();
  FrameRequest request;
  request.scene = model_.loaded.scene;
  request.camera = model_.view.camera;
  request.options = model_.frameOptions(windowPx_);
  request.exposure = model_.view.exposure;
  request.view = view_;
  request.scale = inFull ? 1.0 : moving_.scale();
  request.options.withSeen = inFull;
  request.options.widthPx = std::max(1, int(request.options.widthPx * request.scale));
  request.options.heightPx = std::max(1, int(request.options.heightPx * request.scale));
  if (asked_.view == request.view && asked_.options.withSeen == inFull) return;
  if (!inFull && drawer_.isBusy()) return;  // the next one when this one is there, of the view as it is then
  asked_ = request;
  drawer_.ask(std::move(request));
}

void Viewer::askForTruth() {
  if (model_.view.comparison == Comparison::None || !isAtRest() || !isFrameSettled() || tracer_.isBusy())
    return;
  const int pass = model_.truthIsCurrent() ? model_.truth->pass + 1 : 0;
  if (pass >= kTruthPasses) return;
  cancelTruth_ = std::make_shared<std::atomic<bool>>(false);
  tracer_.ask({model_.frame, cancelTruth_, pass});
  model_.isTracing = true;
}

void Viewer::askForMaps() {
  if (!model_.view.mapsOf || mapper_.isBusy()) return;
  const MapsRequest request{model_.loaded.scene, model_.view.camera.eye, *model_.view.mapsOf};
  if (askedMaps_.scene == request.scene && askedMaps_.eye == request.eye &&
      askedMaps_.reflector == request.reflector)
    return;
  askedMaps_ = request;
  mapper_.ask(request);
}

}  // namespace

void runViewer(const ViewerOptions& options) {
  Viewer(options).run();
}

}  // namespace catoptric::viewer
