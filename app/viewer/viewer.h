// SPDX-License-Identifier: Apache-2.0
// The interactive viewer: a window that always answers, with loading, drawing and tracing on threads behind
// it.
#pragma once

#include <string>
#include <vector>

#include "method_variant.h"
#include "viewer/jobs.h"
#include "viewer/session.h"

namespace catoptric::viewer {

struct ViewerOptions {
  LoadRequest scene;               ///< what to open first
  std::vector<std::string> files;  ///< of a folder, to step through; may be empty
  renderer::FrameOptions frame;    ///< its size is the window's first size
  float exposure = 1;
  bool watch = false;  ///< load the file again when it changes
  std::vector<app::MethodVariant> variants;
  std::size_t variant = 0;                ///< the one to start with
  std::vector<std::string> sceneOptions;  ///< as typed, for the command line that is copied
  std::optional<Session> session;         ///< to return to; its scene is `scene`
  std::string sessionFile;                ///< where ctrl-S goes; empty: a new file each time
  std::function<void(const std::string& file, const Session&)> saveSession;
  Load load;
  /// Reports that are not the window's business: first picture, screenshots, copied commands.
  std::function<void(const std::string&)> sayDetail, say, printLine;
};

/// Returns when the window is closed. Throws core::Error when no window can be opened or the first scene
/// cannot be loaded.
void runViewer(const ViewerOptions& options);

}  // namespace catoptric::viewer
