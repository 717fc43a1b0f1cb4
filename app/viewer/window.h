// SPDX-License-Identifier: Apache-2.0
// The window: GLFW and Dear ImGui, made and destroyed together. The only folder that sees either. Its OpenGL
// context draws panels and shows finished pictures, nothing else (docs/decisions.md).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "catoptric/core/image.h"

struct ImDrawList;

namespace catoptric::viewer {

struct KeyPress {
  int key = 0;  ///< GLFW's
  bool control = false, shift = false;
};

/// The connection to the display; needed as long as there is a window.
class WindowSystem {
 public:
  /// Throws core::Error("window.unavailable") where there is no display, with what to do.
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;
};

class Window {
 public:
  /// Throws core::Error("window.unavailable") where the display has no OpenGL 3.3, with what to do.
  Window(const std::string& title, int widthPx, int heightPx);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// The process ends when its display does, and does this before, if the calling thread is the one to find
  /// out. It must not touch the window.
  void beforeDisplayIsLost(std::function<void()> say);

  [[nodiscard]] bool shouldClose() const;
  void close();
  void setTitle(const std::string& title);
  /// Returns at the first event, after wake(), or after `seconds`; false when nothing happened.
  bool waitForEvents(double seconds);
  /// Any thread.
  static void wake();

  /// Between the two, ImGui takes calls.
  void beginFrame();
  /// Throws core::Error("gl.lost") when the driver has reset the window's context.
  void endFrame();
  /// Instead of endFrame(): input was taken, the window stays as it is.
  void dropFrame();
  [[nodiscard]] ivec2 sizePx() const;  ///< of the picture area, pixels of the framebuffer

  /// Keys that were pressed since the last call; ImGui alone would miss one that is up again before the next
  /// frame.
  [[nodiscard]] std::vector<KeyPress> takeKeys();
  /// Files that were dropped since the last call.
  [[nodiscard]] std::vector<std::string> takeDroppedFiles();
  void copyText(const std::string& text);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A picture that ImGui can draw. Needs the window's context; make it after the window, destroy it before.
class ShownPicture {
 public:
  ShownPicture() = default;
  ~ShownPicture();
  ShownPicture(const ShownPicture&) = delete;
  ShownPicture& operator=(const ShownPicture&) = delete;

  /// Bilinear when shown larger.
  void set(const core::ImageRgba8& picture);
  /// Pixels stay squares: for maps of ids.
  void setExact(const core::ImageRgba8& picture);
  [[nodiscard]] bool isEmpty() const { return id_ == 0; }
  /// Into a list of ImGui, over what is there: pictures are opaque, and blending all pixels of a window takes
  /// where GL is software as long as reading them.
  void drawOpaque(ImDrawList& list, const vec2& upper, const vec2& lower, const vec2& uvUpper = vec2(0),
                  const vec2& uvLower = vec2(1)) const;
  [[nodiscard]] void* imguiId() const { return reinterpret_cast<void*>(std::uintptr_t(id_)); }

 private:
  void upload(const core::ImageRgba8& picture, int filter);
  unsigned id_ = 0;
};

}  // namespace catoptric::viewer
