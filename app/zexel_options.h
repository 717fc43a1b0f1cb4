// SPDX-License-Identifier: Apache-2.0
// Options of depth-preserving reflection maps, for every command that draws with them.
#pragma once

#include "arguments.h"
#include "catoptric/depth_reflection_map/zexel_options.h"

namespace catoptric::app {

void declareZexels(Arguments& arguments, depth_reflection_map::ZexelOptions& options);

}  // namespace catoptric::app
