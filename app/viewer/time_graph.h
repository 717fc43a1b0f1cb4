// SPDX-License-Identifier: Apache-2.0
// What a frame's time went into, as a graph of the last frames and as numbers.
#pragma once

#include "viewer/model.h"

namespace catoptric::viewer {

void drawTimes(const Model& model);

}  // namespace catoptric::viewer
