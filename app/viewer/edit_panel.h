// SPDX-License-Identifier: Apache-2.0
// The panels that change the scene: the picked object and its material, the time of the animations.
#pragma once

#include "viewer/model.h"

namespace catoptric::viewer {

void drawSelected(Model& model);
void drawAnimation(Model& model);

}  // namespace catoptric::viewer
