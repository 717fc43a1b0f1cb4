// SPDX-License-Identifier: Apache-2.0
// The command line that draws what is on the screen.
#pragma once

#include <string>
#include <vector>

#include "catoptric/renderer/frame.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {

/// "catoptric render SCENE -o picture.png ..."; numbers with all their digits, so that it draws the same
/// picture to the byte. `sceneOptions`: what the viewer was started with that changes the scene.
[[nodiscard]] std::string makeCommandText(const LoadRequest& scene, const scene::Camera& camera,
                                          const renderer::FrameOptions& options, float exposure,
                                          const std::vector<std::string>& sceneOptions);

/// A word as a shell reads it back.
[[nodiscard]] std::string quoteForShell(const std::string& word);

}  // namespace catoptric::viewer
