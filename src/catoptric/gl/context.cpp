// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>
#include <glad/gl.h>

#include <array>
#include <cstring>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/gl/reset_status.h"

namespace catoptric::gl {
namespace {

bool hasExtension(const char* list, const char* name) {
  const std::string padded = fmt::format(" {} ", list ? list : "");
  return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

/// The EGL displays that need no window system, best first.
EGLDisplay openDisplay(int attempt) {
  const auto getPlatformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const char* clientExtensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (attempt == 0) {
    if (!getPlatformDisplay || !hasExtension(clientExtensions, "EGL_MESA_platform_surfaceless"))
      return EGL_NO_DISPLAY;
    return getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  }
  if (attempt == 1) {
    const auto queryDevices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (!getPlatformDisplay || !queryDevices || !queryDevices(1, &device, &count) || count < 1)
      return EGL_NO_DISPLAY;
    return getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  }
  return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

}  // namespace

struct Context::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string description;
  std::string pendingMessage;
  bool software = false;

  static void GLAD_API_PTR onMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei,
                                     const GLchar* text, const void* user) {
    if (type == GL_DEBUG_TYPE_PERFORMANCE) return;
    if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH &&
        severity != GL_DEBUG_SEVERITY_MEDIUM)
      return;
    auto* self = static_cast<Impl*>(const_cast<void*>(user));
    if (self->pendingMessage.empty()) self->pendingMessage = text;
  }

  /// `tellsResets`: else a context that the driver resets goes on as if nothing were, which some drivers
  /// cannot do otherwise.
  [[nodiscard]] EGLContext createContext(EGLConfig config, bool debug, bool tellsResets) const {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       3,
                                   EGL_CONTEXT_MINOR_VERSION,       3,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_DEBUG,        debug ? EGL_TRUE : EGL_FALSE};
    if (tellsResets)
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    attributes.push_back(EGL_NONE);
    return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  }

  bool open(int attempt, bool debug) {
    display = openDisplay(attempt);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return false;
    if (!eglBindAPI(EGL_OPENGL_API)) return false;
    const std::array<EGLint, 5> configAttributes{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                                 EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configCount = 0;
    if (!eglChooseConfig(display, configAttributes.data(), &config, 1, &configCount) || configCount < 1)
      config = nullptr;  // EGL_KHR_no_config_context
    context = createContext(config, debug, true);
    if (context == EGL_NO_CONTEXT) context = createContext(config, debug, false);
    if (context == EGL_NO_CONTEXT) return false;
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return false;
    return gladLoadGL(reinterpret_cast<GLADloadfunc>(eglGetProcAddress)) != 0;
  }

  void close() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
    display = EGL_NO_DISPLAY;  // not terminated: another Context of this process may use it
  }
};

Context::Context(const ContextOptions& options) : impl_(std::make_unique<Impl>()) {
  bool isOpen = false;
  for (int attempt = 0; attempt < 3 && !isOpen; ++attempt) {
    isOpen = impl_->open(attempt, options.debug);
    if (!isOpen) impl_->close();
  }
  if (!isOpen)
    throw core::Error("gl.unavailable", "no OpenGL 3.3 core context could be made through EGL", {},
                      "install a driver (Debian: libegl1 and libgl1-mesa-dri) or use --method raytrace");
  const auto text = [](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return std::string(value ? value : "?");
  };
  impl_->description = fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
  impl_->software = isSoftwareRenderer(text(GL_RENDERER));
  if (options.debug && GLAD_GL_KHR_debug) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(&Impl::onMessage, impl_.get());
  }
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

bool isSoftwareRenderer(std::string_view name) {
  for (const std::string_view software : {"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                          "Software Rasterizer", "GDI Generic", "Basic Render Driver"})
    if (name.find(software) != std::string_view::npos) return true;
  return false;
}

Context::~Context() {
  impl_->close();
}

void Context::makeCurrent() {
  if (!eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
    throw core::Error("gl.lost", "the OpenGL context can no longer be made current");
}

void Context::check(const char* where) {
  throwIfReset("renderer", GLAD_GL_KHR_robustness ? glad_glGetGraphicsResetStatus : nullptr);
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR && impl_->pendingMessage.empty()) return;
  std::string message = impl_->pendingMessage;
  impl_->pendingMessage.clear();
  if (error == GL_OUT_OF_MEMORY)
    throw core::Error("gl.out_of_memory", fmt::format("OpenGL ran out of memory in {}", where), {},
                      "use a smaller --size or fewer --bounces");
  throw core::Error("gl.error", fmt::format("OpenGL error 0x{:04x} in {} {}", error, where, message));
}

void Context::finish() {
  glFinish();
}

const std::string& Context::description() const {
  return impl_->description;
}

bool isSoftwareContext() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name && isSoftwareRenderer(name);
}

int maxVaryingComponents() {
  GLint components = 0;
  glGetIntegerv(GL_MAX_VARYING_COMPONENTS, &components);
  return components;
}

bool Context::isSoftware() const {
  return impl_->software;
}

}  // namespace catoptric::gl
