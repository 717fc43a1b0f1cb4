// SPDX-License-Identifier: Apache-2.0
// The loop behind viewer.h: wait for an event or for work that is done, take results, let the user act, draw,
// ask for what is missing. Nothing in here takes long.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/command_text.h"
#include "viewer/panels.h"
#include "viewer/picture_view.h"
#include "viewer/resolution.h"
#include "viewer/viewer.h"
#include "viewer/watched_file.h"
#include "viewer/window.h"

namespace catoptric::viewer {

class ViewerLoop {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ViewerLoop(const ViewerOptions& options);
  /// A pass of the truth that nobody will see need not be finished.
  ~ViewerLoop() {
    if (cancelTruth_) *cancelTruth_ = true;
  }
  ViewerLoop(const ViewerLoop&) = delete;
  ViewerLoop& operator=(const ViewerLoop&) = delete;
  void run();

 private:
  [[nodiscard]] static double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  void takeResults();
  void takeSceneOrStay();
  void takeScene(LoadResult result);
  void useCameraOf(const LoadResult& result);
  void takeFrame(FrameResult result);
  void takeFrameOrTryAgain();
  void takeTruth(TruthResult result);
  void takePreview(TruthResult result);
  void takeMaps(MapsResult result);
  void openDropped();
  void grantWishes();
  void show();
  void writeScreenshot();
  void advanceTime();
  void switchRecording();
  void undoOrRedo(bool undo);
  void saveSession();
  void rescueEdits();
  [[nodiscard]] std::vector<std::string> makeSceneWords() const;
  [[nodiscard]] std::string commandText() const {
    return makeCommandText(model_.loaded.request, model_.view.camera, model_.frameOptions(windowPx_),
                           model_.view.exposure, makeSceneWords());
  }
  [[nodiscard]] FrameRequest makeFrameRequest() const;  ///< of the view as it is, in full
  void askForFrame();
  void askForPreview();
  void askForTruth();
  void askForMaps();
  void askForElsewhere();
  void load(LoadRequest request);
  void tell(const std::string& message, bool isError = false);
  void tellFailure(const std::exception& error);
  [[nodiscard]] double waitSeconds() const;
  [[nodiscard]] bool isAtRest() const;
  [[nodiscard]] bool isWorthShowing() const;
  /// False while the renderer makes ready for a scene.
  [[nodiscard]] bool hasFrameOfScene() const {
    return model_.frame.frame && model_.frame.request.scene == model_.loaded.scene;
  }
  /// True when the frame shown is the current view in full.
  [[nodiscard]] bool isFrameSettled() const {
    return model_.frame.frame && model_.frame.request.view == view_ && model_.frame.request.options.withSeen;
  }

  const ViewerOptions& options_;
  Clock::time_point start_ = Clock::now();
  WindowSystem windowSystem_;  // before the workers: no need to load anything where there is no display
  // Workers outlive the window: it is gone at once when it is closed, however long the work in hand takes.
  std::shared_ptr<std::atomic<LoadStep>> loadStep_ = std::make_shared<std::atomic<LoadStep>>();
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
  Clock::time_point lastChange_{}, messageTime_{}, lastAdvance_{}, lastShown_{}, previewTime_{};
  bool hasNewPicture_ = false;       ///< that the window does not show yet
  std::vector<const char*> firsts_;  ///< what it shows for the first time, of which there is to be said when
  std::optional<Clock::time_point> oldestUnasked_;  ///< change that no frame was asked for yet
  std::uint64_t view_ = 1;
  bool isFirstInFull_ = false;   ///< a picture in full has been shown
  bool hasLostContext_ = false;  ///< of the drawer, and no frame has come since
  LoadRequest lastLoad_;         ///< asked for, or what is there if that has failed
  FrameRequest asked_, askedElsewhere_;
  MapsRequest askedMaps_;
  ScenePointer withoutPreview_;                     ///< rays through it have failed
  std::shared_ptr<std::atomic<bool>> cancelTruth_;  ///< of the pass in hand
  ivec2 windowPx_{0};
  int drawsLeft_ = 3;  ///< ImGui reacts to an event a frame or two later
};

}  // namespace catoptric::viewer
