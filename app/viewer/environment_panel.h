// SPDX-License-Identifier: Apache-2.0
// What surrounds the scene: the built-in sky, or a file.
#pragma once

#include "viewer/model.h"

namespace catoptric::viewer {

/// A list of the sky, of the files that were opened in this window and of those beside the present one, or
/// beside the scene. One that is picked is loaded, the eye stays where it is.
void drawEnvironments(Model& model);

}  // namespace catoptric::viewer
