// SPDX-License-Identifier: Apache-2.0
#include "viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>
#include <imgui_impl_opengl3_loader.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "catoptric/core/error.h"
#include "catoptric/gl/reset_status.h"

namespace catoptric::viewer {
namespace {

constexpr int kLinear = 0x2601, kNearest = 0x2600;  // GL_LINEAR, GL_NEAREST

std::string& lastGlfwError() {
  static std::string text;
  return text;
}

void onGlfwError(int, const char* text) {
  lastGlfwError() = text;
}

[[noreturn]] void throwUnavailable(const std::string& needs = {}) {
  throw core::Error(
      "window.unavailable", "no window can be opened: " + needs + lastGlfwError(), {},
      "run it in a graphical session, or draw to a file: catoptric render SCENE -o picture.png");
}

/// What is done before the process ends with its display, and the thread that may do it.
struct LastWords {
  std::function<void()> say;
  std::thread::id thread;
};

LastWords& lastWords() {
  static LastWords words;
  return words;
}

/// Xlib calls this when the display's server is gone, and ends the process when it returns.
int onDisplayLost(void*) {
  if (lastWords().say && lastWords().thread == std::this_thread::get_id()) lastWords().say();
  std::fputs("catoptric: error: the connection to the display was lost\n", stderr);
  std::_Exit(1);  // not exit(): threads are at work
}

/// Where GLFW has loaded Xlib.
void watchDisplay() {
  void* xlib = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  if (xlib == nullptr) return;
  using Handler = int (*)(void*);
  if (auto* const set = reinterpret_cast<Handler (*)(Handler)>(dlsym(xlib, "XSetIOErrorHandler")))
    set(onDisplayLost);
}

/// Other threads wake the window while it may be closing.
struct OpenState {
  std::mutex mutex;
  bool isOpen = false;
};

OpenState& openState() {
  static OpenState state;
  return state;
}

void setOpen(bool isOpen) {
  const std::lock_guard lock(openState().mutex);
  openState().isOpen = isOpen;
}

}  // namespace

struct Window::Impl {
  GLFWwindow* window = nullptr;
  gl::ResetQuery resetQuery = nullptr;
  std::vector<std::string> dropped;
  std::vector<KeyPress> keys;

  static void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
    auto* self = static_cast<Impl*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_PRESS)
      self->keys.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0});
  }

  static void onDrop(GLFWwindow* window, int count, const char** paths) {
    auto* self = static_cast<Impl*>(glfwGetWindowUserPointer(window));
    self->dropped.assign(paths, paths + count);
  }

  void open(const std::string& title, int widthPx, int heightPx) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);  // where the driver offers it
    window = glfwCreateWindow(widthPx, heightPx, title.c_str(), nullptr, nullptr);
    if (!window) throwUnavailable("it needs OpenGL 3.3: ");
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    if (glfwGetWindowAttrib(window, GLFW_CONTEXT_ROBUSTNESS) == GLFW_LOSE_CONTEXT_ON_RESET)
      resetQuery = reinterpret_cast<gl::ResetQuery>(glfwGetProcAddress("glGetGraphicsResetStatusARB"));
    glfwSetWindowUserPointer(window, this);
    glfwSetDropCallback(window, onDrop);
    glfwSetKeyCallback(window, onKey);  // before ImGui, which calls it in turn
  }
};

WindowSystem::WindowSystem() {
  glfwSetErrorCallback(onGlfwError);
  if (!glfwInit()) throwUnavailable();
  watchDisplay();
}

WindowSystem::~WindowSystem() {
  glfwTerminate();
}

Window::Window(const std::string& title, int widthPx, int heightPx) : impl_(std::make_unique<Impl>()) {
  impl_->open(title, widthPx, heightPx);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = 4.0f;
  ImGui_ImplGlfw_InitForOpenGL(impl_->window, true);
  if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
    lastGlfwError() = "its OpenGL functions could not be loaded";
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(impl_->window);
    throwUnavailable();
  }
  setOpen(true);
}

Window::~Window() {
  setOpen(false);
  lastWords() = {};
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(impl_->window);
}

void Window::beforeDisplayIsLost(std::function<void()> say) {
  lastWords() = {std::move(say), std::this_thread::get_id()};
}

bool Window::shouldClose() const {
  return glfwWindowShouldClose(impl_->window) != 0;
}

void Window::close() {
  glfwSetWindowShouldClose(impl_->window, GLFW_TRUE);
}

void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(impl_->window, title.c_str());
}

bool Window::waitForEvents(double seconds) {
  if (seconds <= 0) {
    glfwPollEvents();
    return true;
  }
  const auto start = std::chrono::steady_clock::now();
  glfwWaitEventsTimeout(seconds);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 0.95 * seconds;
}

void Window::wake() {
  const std::lock_guard lock(openState().mutex);
  if (openState().isOpen) glfwPostEmptyEvent();
}

void Window::beginFrame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::endFrame() {
  ImGui::Render();
  const ivec2 size = sizePx();
  glViewport(0, 0, size.x, size.y);
  glClearColor(0.06f, 0.06f, 0.07f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(impl_->window);
  gl::throwIfReset("window", impl_->resetQuery);
}

void Window::dropFrame() {
  ImGui::EndFrame();
}

ivec2 Window::sizePx() const {
  ivec2 size(0);
  glfwGetFramebufferSize(impl_->window, &size.x, &size.y);
  return size;
}

std::vector<KeyPress> Window::takeKeys() {
  return std::exchange(impl_->keys, {});
}

std::vector<std::string> Window::takeDroppedFiles() {
  return std::exchange(impl_->dropped, {});
}

void Window::copyText(const std::string& text) {
  glfwSetClipboardString(impl_->window, text.c_str());
}

ShownPicture::~ShownPicture() {
  if (id_ != 0) glDeleteTextures(1, &id_);
}

void ShownPicture::set(const core::ImageRgba8& picture) {
  upload(picture, kLinear);
}

void ShownPicture::setExact(const core::ImageRgba8& picture) {
  upload(picture, kNearest);
}

void ShownPicture::drawOpaque(ImDrawList& list, const vec2& upper, const vec2& lower, const vec2& uvUpper,
                              const vec2& uvLower) const {
  list.AddCallback([](const ImDrawList*, const ImDrawCmd*) { glDisable(GL_BLEND); }, nullptr);
  list.AddImage(imguiId(), ImVec2(upper.x, upper.y), ImVec2(lower.x, lower.y), ImVec2(uvUpper.x, uvUpper.y),
                ImVec2(uvLower.x, uvLower.y));
  list.AddCallback([](const ImDrawList*, const ImDrawCmd*) { glEnable(GL_BLEND); }, nullptr);
}

void ShownPicture::upload(const core::ImageRgba8& picture, int filter) {
  if (picture.isEmpty()) return;
  if (id_ == 0) glGenTextures(1, &id_);
  glBindTexture(GL_TEXTURE_2D, id_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, 0x2802,
                  0x812F);  // wrap both ways: clamp to edge, which ImGui's loader does not name
  glTexParameteri(GL_TEXTURE_2D, 0x2803, 0x812F);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, picture.width(), picture.height(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
               picture.data());
}

}  // namespace catoptric::viewer
