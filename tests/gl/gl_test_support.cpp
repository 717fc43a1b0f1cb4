// SPDX-License-Identifier: Apache-2.0
#include "gl_test_support.h"

#include <glad/gl.h>

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "catoptric/core/error.h"
#include "catoptric/gl/program.h"

namespace catoptric::gl::test {
namespace {

/// A shader of the product without the lines that assembleShader() puts before it.
std::string libraryText(const std::string& name) {
  const std::string text = assembleShader(name, {});
  return text.substr(text.find('\n', text.find("#define CATOPTRIC_FN")) + 1);
}

std::string readShader(const std::string& file) {
  std::ifstream in(std::string(CATOPTRIC_SOURCE_DIR "/tests/gl/shaders/") + file);
  if (!in) throw std::runtime_error("no test shader " + file);
  const std::string empty = assembleShader("raster/screen.vert", {});
  std::string source = empty.substr(0, empty.find('\n', empty.find("#define CATOPTRIC_FN")) + 1);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("#include \"", 0) == 0)
      source += libraryText(line.substr(10, line.find('"', 10) - 10));
    else
      source += line + "\n";
  }
  return source;
}

unsigned compileStage(GLenum stage, const std::string& file) {
  const std::string source = readShader(file);
  const char* text = source.c_str();
  const unsigned shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint isCompiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &isCompiled);
  if (!isCompiled) {
    std::array<char, 1024> log{};
    glGetShaderInfoLog(shader, GLsizei(log.size()), nullptr, log.data());
    throw std::runtime_error(file + ": " + log.data());
  }
  return shader;
}

}  // namespace

Context& GlTest::context() {
  static Context context({.debug = true});
  return context;
}

void GlTest::TearDown() {
  EXPECT_NO_THROW(context().check("the test"));
}

void GlTest::forgetMessages() {
  try {
    context().check("a provoked failure");
  } catch (const core::Error&) {
    return;  // some drivers tell it as a debug message too
  }
}

TestProgram::TestProgram(const std::string& vertexFile, const std::string& fragmentFile)
    : id_(glCreateProgram()) {
  const unsigned vertex = compileStage(GL_VERTEX_SHADER, vertexFile);
  const unsigned fragment = compileStage(GL_FRAGMENT_SHADER, fragmentFile);
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint isLinked = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &isLinked);
  if (!isLinked) throw std::runtime_error(vertexFile + " and " + fragmentFile + " do not link");
}

TestProgram::~TestProgram() {
  glDeleteProgram(id_);
}

void TestProgram::use() const {
  glUseProgram(id_);
}

void TestProgram::set(const char* uniform, int value) const {
  glUniform1i(glGetUniformLocation(id_, uniform), value);
}

FloatTarget::FloatTarget(int widthPx, int heightPx)
    : texture(TextureKind::Flat, Format::Rgba32F, widthPx, heightPx, 1, 1, {}),
      framebuffer(std::array<const Texture*, 1>{&texture}, nullptr) {}

std::vector<vec4> FloatTarget::read() const {
  std::vector<vec4> pixels(std::size_t(texture.width()) * std::size_t(texture.height()));
  framebuffer.readPixels(0, std::span<vec4>(pixels));
  return pixels;
}

}  // namespace catoptric::gl::test
