// SPDX-License-Identifier: Apache-2.0
// The picture behind the panels: the method's, or the method's beside the truth, or what tells them apart.
#pragma once

#include "viewer/model.h"
#include "viewer/window.h"

namespace catoptric::viewer {

struct ShownPictures {
  ShownPicture method, truth, difference, displacement;
};

/// Between Window::beginFrame() and endFrame().
void drawPicture(const Model& model, const ShownPictures& pictures, const ivec2& windowPx);

/// The same as an image of the frame's size, for a screenshot; without line and captions.
[[nodiscard]] core::ImageRgba8 composeShownPicture(const Model& model);

}  // namespace catoptric::viewer
