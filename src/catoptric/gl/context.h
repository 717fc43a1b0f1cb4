// SPDX-License-Identifier: Apache-2.0
// A headless OpenGL 3.3 core context through EGL: no display server and no GPU needed (Mesa's llvmpipe
// serves).
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace catoptric::gl {

/// Whether GL_RENDERER names a rasterizer that runs on the processor.
[[nodiscard]] bool isSoftwareRenderer(std::string_view name);
/// The same of the current context.
[[nodiscard]] bool isSoftwareContext();
/// Floats that its vertex shaders may hand on, 60 at least.
[[nodiscard]] int maxVaryingComponents();

struct ContextOptions {
  /// Debug context: any GL error or message of medium or high severity is remembered and thrown by check().
  bool debug = false;
};

/// Makes the context current on the calling thread; all other classes of this folder need a current context.
class Context {
 public:
  /// Tries EGL surfaceless, then EGL devices, then the default display. Throws core::Error("gl.unavailable").
  explicit Context(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void makeCurrent();
  /// Throws core::Error("gl.error") if GL reported an error since the last call, "gl.lost" if the driver has
  /// reset the context (reset_status.h).
  void check(const char* where);
  /// Waits until the GPU has done everything; for timing.
  void finish();

  /// "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 core, Mesa 22.3.6"
  [[nodiscard]] const std::string& description() const;
  [[nodiscard]] bool isSoftware() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptric::gl
