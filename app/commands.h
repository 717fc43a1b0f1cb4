// SPDX-License-Identifier: Apache-2.0
// The commands; each has a file of its name.
#pragma once

#include "arguments.h"

namespace catoptric::app {

[[nodiscard]] Command makeInfoCommand();
[[nodiscard]] Command makeRenderCommand();
[[nodiscard]] Command makeCompareCommand();
[[nodiscard]] Command makeBenchCommand();
[[nodiscard]] Command makeBakeCommand();
/// Is it a file of `bake`? False for what cannot be read.
[[nodiscard]] bool isBakedFile(const std::string& path);
/// What info says of it: printed, and as a document.
void describeBakedFile(const std::string& path, const std::string& jsonFile);
[[nodiscard]] Command makeDrawCommand();
[[nodiscard]] Command makeScenesCommand();
[[nodiscard]] Command makeViewCommand();

}  // namespace catoptric::app
