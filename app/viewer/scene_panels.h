// SPDX-License-Identifier: Apache-2.0
// Panels about the mirrors of the scene.
#pragma once

#include "viewer/panels.h"

namespace catoptric::viewer {

/// Each mirror with its recognised shape, what `auto` picks and why, and a switch.
void drawReflectors(Model& model);
/// The explosion maps of the mirror that was asked for.
void drawMaps(Model& model, const MapPictures& maps);

}  // namespace catoptric::viewer
