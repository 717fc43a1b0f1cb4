// SPDX-License-Identifier: Apache-2.0
// The commands; each has a file of its name.
#pragma once

#include "arguments.h"

namespace catoptric::app {

[[nodiscard]] Command makeInfoCommand();
[[nodiscard]] Command makeRenderCommand();
[[nodiscard]] Command makeCompareCommand();
[[nodiscard]] Command makeBenchCommand();
[[nodiscard]] Command makeScenesCommand();
[[nodiscard]] Command makeViewCommand();

}  // namespace catoptric::app
