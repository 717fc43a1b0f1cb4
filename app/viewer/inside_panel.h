// SPDX-License-Identifier: Apache-2.0
// Inside the method: virtual objects, cells, octrees and zexels of one mirror, seen by a second, free camera.
#pragma once

#include "viewer/model.h"
#include "viewer/picture_view.h"

namespace catoptric::viewer {

/// Opens it for a mirror; the second camera starts beside the eye, with mirror and eye in view.
void lookInside(Model& model, std::uint32_t reflector);

/// Of the mirror under the mouse, else of the first curved one, else of the first; closes it if it is open.
void switchInside(Model& model);

void drawInside(Model& model, const ShownPicture& picture);

}  // namespace catoptric::viewer
