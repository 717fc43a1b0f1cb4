// SPDX-License-Identifier: Apache-2.0
// Keys and mouse over the picture to changes of the model; docs/viewer.md lists them.
#pragma once

#include <span>

#include "viewer/model.h"
#include "viewer/window.h"

namespace catoptric::viewer {

/// Between Window::beginFrame() and endFrame(), after the panels: they take what is theirs first.
void handleInput(Model& model, std::span<const KeyPress> keys, const ivec2& windowPx);

struct KeyHelp {
  const char* key;
  const char* meaning;
};
[[nodiscard]] std::span<const KeyHelp> keyHelp();

}  // namespace catoptric::viewer
