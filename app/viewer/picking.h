// SPDX-License-Identifier: Apache-2.0
// What is under the mouse, from what the frame says is seen there.
#pragma once

#include <optional>

#include "viewer/model.h"

namespace catoptric::viewer {

/// `at`: share of the picture's width and height, from the top left corner. Nothing when the frame does not
/// know what is seen (it was drawn while moving) or `at` is outside.
[[nodiscard]] std::optional<Picked> pick(const FrameResult& frame, const dvec2& at);

}  // namespace catoptric::viewer
