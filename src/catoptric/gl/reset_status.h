// SPDX-License-Identifier: Apache-2.0
// Whether the driver has reset a context: after that its calls do nothing, and what it held is gone.
#pragma once

#include <string_view>

namespace catoptric::gl {

/// glGetGraphicsResetStatus of the current context.
using ResetQuery = unsigned (*)();

/// Throws core::Error("gl.lost") with the cause when the driver has reset the current context since the last
/// question. `context`: "renderer" or "window"; `query` null: the driver does not tell.
/// For tests, since no software renderer is ever reset: where the environment variable
/// CATOPTRIC_FAKE_GL_RESET names a folder, a file in it that is called as the context is taken for the
/// driver's answer, once (it is removed).
void throwIfReset(std::string_view context, ResetQuery query);

}  // namespace catoptric::gl
