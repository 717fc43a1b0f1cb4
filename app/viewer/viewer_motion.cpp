// SPDX-License-Identifier: Apache-2.0
// Time that goes on by itself, frames that are recorded, edits that are undone, sessions that are saved, also
// by an end that nobody has asked for.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "catoptric/core/error.h"
#include "viewer/viewer_loop.h"

namespace catoptric::viewer {
namespace {

constexpr double kRecordedFramesPerS = 25;

/// "NAME-0001.EXTENSION", the first number that is free; no extension for a folder.
std::string findFreeName(const std::string& name, const std::string& extension) {
  for (int number = 1;; ++number) {
    std::string file = fmt::format("{}-{:04}{}", name, number, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

}  // namespace

void ViewerLoop::advanceTime() {
  const Clock::time_point now = Clock::now();
  const double passed = std::chrono::duration<double>(now - lastAdvance_).count();
  ViewState& view = model_.view;
  if (!view.isPlaying || model_.loaded.durationS <= 0) {
    lastAdvance_ = now;
    return;
  }
  if (drawer_.isBusy() || !model_.frame.frame) return;  // the next frame shows the time it is asked for at
  lastAdvance_ = now;
  const double step = model_.recording ? 1.0 / kRecordedFramesPerS : passed;
  view.state.timeS = std::fmod(view.state.timeS.value_or(0.0) + step, model_.loaded.durationS);
  model_.wishes.viewChanged = true;
}

void ViewerLoop::switchRecording() {
  if (model_.recording) {
    const Recording done = *model_.recording;
    model_.recording.reset();
    model_.wishes.viewChanged = true;  // a frame in full, with what is seen
    tell(fmt::format("recorded {} frames in {}", done.frames, done.folder));
    return options_.say(fmt::format("recorded {} frames in {}", done.frames, done.folder));
  }
  Recording started;
  started.folder = findFreeName(model_.loaded.scene->name + "-frames", "");
  std::error_code failed;
  if (!std::filesystem::create_directory(started.folder, failed))
    return tell(fmt::format("cannot make the folder '{}': {}", started.folder, failed.message()), true);
  model_.recording = started;
  model_.wishes.viewChanged = true;
  tell("recording into " + started.folder);
}

void ViewerLoop::undoOrRedo(bool undo) {
  const auto& materials = model_.loaded.scene->scene.materials;
  SceneState& state = model_.view.state;
  if (model_.drag) return;
  const bool changed = undo ? model_.edits.undo(state, materials) : model_.edits.redo(state, materials);
  if (changed) model_.wishes.viewChanged = true;
  tell(changed ? undo ? "undone" : "done again" : undo ? "nothing to undo" : "nothing to do again");
}

void ViewerLoop::saveSession() {
  const std::string file = options_.sessionFile.empty()
                               ? findFreeName(model_.loaded.scene->name, ".session.json")
                               : options_.sessionFile;
  try {
    options_.saveSession(file, makeSession(model_, windowPx_));
    options_.say("wrote " + file);
    tell("wrote " + file + "; catoptric view --session " + quoteForShell(file) + " returns to it");
  } catch (const std::exception& error) {
    tell(error.what(), true);
  }
}

/// Of an end that the user has not asked for: what was edited is not lost. A new file, whatever --session
/// says.
void ViewerLoop::rescueEdits() {
  if (!model_.loaded.scene || !model_.view.state.hasEdits()) return;
  const std::string file = findFreeName(model_.loaded.scene->name + "-rescued", ".session.json");
  try {
    options_.saveSession(file, makeSession(model_, windowPx_));
    options_.say("the edits are kept: catoptric view --session " + quoteForShell(file));
  } catch (const std::exception& error) {
    options_.say(std::string("the edits could not be kept: ") + error.what());
  }
}

}  // namespace catoptric::viewer
