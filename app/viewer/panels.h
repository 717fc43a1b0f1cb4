// SPDX-License-Identifier: Apache-2.0
// The panels over the picture.
#pragma once

#include "viewer/model.h"
#include "viewer/window.h"

namespace catoptric::viewer {

/// Pictures that panels show; the viewer fills them.
struct MapPictures {
  ShownPicture nearMap, farMap, hiddenMap, inside;
};

/// Between Window::beginFrame() and endFrame().
void drawPanels(Model& model, const MapPictures& maps);

}  // namespace catoptric::viewer
