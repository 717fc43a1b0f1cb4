// SPDX-License-Identifier: Apache-2.0
// The files of shaders/, compiled into the library by scripts/embed_shaders.py.
#pragma once

#include <span>

namespace catoptric::gl {

struct EmbeddedShader {
  const char* name;  ///< path below shaders/, e.g. "lib/brdf.glsl"
  const char* text;
};

[[nodiscard]] std::span<const EmbeddedShader> embeddedShaders();

}  // namespace catoptric::gl
