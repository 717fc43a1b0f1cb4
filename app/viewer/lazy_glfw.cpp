// SPDX-License-Identifier: Apache-2.0
// GLFW's functions, found in libglfw.so.3 when the first of them is called. Linked the usual way, the library
// (and X11's with it) would have to be there before `catoptric render` starts on a server that has no use for
// them; and the command could no longer be copied to another machine. The functions are those that window.cpp
// and ImGui's backend call.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>

namespace {

GLFWerrorfun errorCallback = nullptr;

void* openGlfw() {
  static void* const library = [] {
    void* opened = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
    if (opened == nullptr && errorCallback != nullptr)
      errorCallback(GLFW_PLATFORM_ERROR, "GLFW is missing (Debian: apt-get install libglfw3)");
    return opened;
  }();
  return library;
}

/// Null where the library is missing. Only glfwInit and the error callback are called then.
template <class Function>
Function* findGlfw(const char* name) {
  void* library = openGlfw();
  return library == nullptr ? nullptr : reinterpret_cast<Function*>(dlsym(library, name));
}

}  // namespace

// One line a function: what it returns, its name, its parameters, its arguments.
#define CATOPTRIC_GLFW(result, name, parameters, arguments)           \
  result name parameters {                                            \
    static auto* const function = findGlfw<result parameters>(#name); \
    return function arguments;                                        \
  }

extern "C" {

int glfwInit() {
  auto* const function = findGlfw<int()>("glfwInit");
  if (function == nullptr) return GLFW_FALSE;
  return function();
}

GLFWerrorfun glfwSetErrorCallback(GLFWerrorfun callback) {
  errorCallback = callback;
  auto* const function = findGlfw<GLFWerrorfun(GLFWerrorfun)>("glfwSetErrorCallback");
  return function == nullptr ? nullptr : function(callback);
}

CATOPTRIC_GLFW(void, glfwTerminate, (), ())
CATOPTRIC_GLFW(void, glfwWindowHint, (int hint, int value), (hint, value))
CATOPTRIC_GLFW(GLFWwindow*, glfwCreateWindow,
               (int width, int height, const char* title, GLFWmonitor* monitor, GLFWwindow* share),
               (width, height, title, monitor, share))
CATOPTRIC_GLFW(void, glfwDestroyWindow, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(void, glfwMakeContextCurrent, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(GLFWglproc, glfwGetProcAddress, (const char* name), (name))
CATOPTRIC_GLFW(void, glfwSwapInterval, (int interval), (interval))
CATOPTRIC_GLFW(void, glfwSwapBuffers, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(void, glfwSetWindowUserPointer, (GLFWwindow * window, void* pointer), (window, pointer))
CATOPTRIC_GLFW(void*, glfwGetWindowUserPointer, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(int, glfwWindowShouldClose, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(void, glfwSetWindowShouldClose, (GLFWwindow * window, int value), (window, value))
CATOPTRIC_GLFW(void, glfwSetWindowTitle, (GLFWwindow * window, const char* title), (window, title))
CATOPTRIC_GLFW(void, glfwPollEvents, (), ())
CATOPTRIC_GLFW(void, glfwWaitEventsTimeout, (double seconds), (seconds))
CATOPTRIC_GLFW(void, glfwPostEmptyEvent, (), ())
CATOPTRIC_GLFW(void, glfwGetFramebufferSize, (GLFWwindow * window, int* width, int* height),
               (window, width, height))
CATOPTRIC_GLFW(void, glfwGetWindowSize, (GLFWwindow * window, int* width, int* height),
               (window, width, height))
CATOPTRIC_GLFW(int, glfwGetWindowAttrib, (GLFWwindow * window, int attribute), (window, attribute))
CATOPTRIC_GLFW(double, glfwGetTime, (), ())
CATOPTRIC_GLFW(GLFWcursor*, glfwCreateStandardCursor, (int shape), (shape))
CATOPTRIC_GLFW(void, glfwDestroyCursor, (GLFWcursor * cursor), (cursor))
CATOPTRIC_GLFW(void, glfwSetCursor, (GLFWwindow * window, GLFWcursor* cursor), (window, cursor))
CATOPTRIC_GLFW(void, glfwGetCursorPos, (GLFWwindow * window, double* x, double* y), (window, x, y))
CATOPTRIC_GLFW(void, glfwSetCursorPos, (GLFWwindow * window, double x, double y), (window, x, y))
CATOPTRIC_GLFW(int, glfwGetMouseButton, (GLFWwindow * window, int button), (window, button))
CATOPTRIC_GLFW(int, glfwGetInputMode, (GLFWwindow * window, int mode), (window, mode))
CATOPTRIC_GLFW(void, glfwSetInputMode, (GLFWwindow * window, int mode, int value), (window, mode, value))
CATOPTRIC_GLFW(const float*, glfwGetJoystickAxes, (int joystick, int* count), (joystick, count))
CATOPTRIC_GLFW(const unsigned char*, glfwGetJoystickButtons, (int joystick, int* count), (joystick, count))
CATOPTRIC_GLFW(const char*, glfwGetClipboardString, (GLFWwindow * window), (window))
CATOPTRIC_GLFW(void, glfwSetClipboardString, (GLFWwindow * window, const char* text), (window, text))
CATOPTRIC_GLFW(GLFWcharfun, glfwSetCharCallback, (GLFWwindow * window, GLFWcharfun callback),
               (window, callback))
CATOPTRIC_GLFW(GLFWkeyfun, glfwSetKeyCallback, (GLFWwindow * window, GLFWkeyfun callback), (window, callback))
CATOPTRIC_GLFW(GLFWscrollfun, glfwSetScrollCallback, (GLFWwindow * window, GLFWscrollfun callback),
               (window, callback))
CATOPTRIC_GLFW(GLFWdropfun, glfwSetDropCallback, (GLFWwindow * window, GLFWdropfun callback),
               (window, callback))
CATOPTRIC_GLFW(GLFWmonitorfun, glfwSetMonitorCallback, (GLFWmonitorfun callback), (callback))
CATOPTRIC_GLFW(GLFWmousebuttonfun, glfwSetMouseButtonCallback,
               (GLFWwindow * window, GLFWmousebuttonfun callback), (window, callback))
CATOPTRIC_GLFW(GLFWcursorenterfun, glfwSetCursorEnterCallback,
               (GLFWwindow * window, GLFWcursorenterfun callback), (window, callback))
CATOPTRIC_GLFW(GLFWwindowfocusfun, glfwSetWindowFocusCallback,
               (GLFWwindow * window, GLFWwindowfocusfun callback), (window, callback))

}  // extern "C"
