// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/program.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <sstream>

#include "catoptric/core/error.h"
#include "catoptric/gl/embedded_shaders.h"

namespace catoptric::gl {
namespace {

std::string_view findEmbedded(std::string_view name) {
  for (const EmbeddedShader& shader : embeddedShaders())
    if (name == shader.name) return shader.text;
  throw core::Error("gl.shader", fmt::format("no shader file named '{}' in this build", name));
}

/// Appends the file; lines of the form  #include "path"  are replaced by that file (path below shaders/).
void appendFile(std::string& out, std::string_view name, int depth) {
  if (depth > 8) throw core::Error("gl.shader", fmt::format("shader includes nest too deeply at '{}'", name));
  std::istringstream lines{std::string(findEmbedded(name))};
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("#include \"", 0) == 0) {
      const std::size_t end = line.find('"', 10);
      appendFile(out, line.substr(10, end - 10), depth + 1);
    } else {
      out += line + "\n";
    }
  }
}

unsigned compile(GLenum stage, std::string_view name, const std::vector<std::string>& defines) {
  const std::string source = assembleShader(name, defines);
  const char* text = source.c_str();
  const unsigned shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint isCompiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &isCompiled);
  if (!isCompiled) {
    char log[2048] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glDeleteShader(shader);
    throw core::Error("gl.shader", fmt::format("shader '{}' does not compile: {}", name, log), {},
                      "the driver may be too old; use --method raytrace");
  }
  return shader;
}

}  // namespace

std::string assembleShader(std::string_view name, const std::vector<std::string>& defines) {
  std::string source =
      "#version 330 core\n#define Real float\n#define Real2 vec2\n#define Real3 vec3\n"
      "#define choose(c, a, b) ((c) ? (a) : (b))\n#define anyLane(c) (c)\n#define CATOPTRIC_FN\n";
  for (const std::string& define : defines) source += "#define " + define + "\n";
  appendFile(source, name, 0);
  return source;
}

Program::Program(std::string_view vertexFile, std::string_view fragmentFile,
                 const std::vector<std::string>& defines) {
  const unsigned vertex = compile(GL_VERTEX_SHADER, vertexFile, defines);
  unsigned fragment = 0;
  try {
    fragment = compile(GL_FRAGMENT_SHADER, fragmentFile, defines);
  } catch (...) {
    glDeleteShader(vertex);
    throw;
  }
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint isLinked = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &isLinked);
  if (!isLinked) {
    char log[2048] = "";
    glGetProgramInfoLog(id_, sizeof log, nullptr, log);
    glDeleteProgram(id_);
    throw core::Error("gl.shader",
                      fmt::format("'{}' and '{}' do not link: {}", vertexFile, fragmentFile, log));
  }
}

Program::~Program() {
  glDeleteProgram(id_);
}

void Program::use() const {
  glUseProgram(id_);
}

int Program::location(std::string_view uniform) {
  std::string key(uniform);
  if (const auto found = locations_.find(key); found != locations_.end()) return found->second;
  const int place = glGetUniformLocation(id_, key.c_str());
  locations_.emplace(std::move(key), place);
  return place;
}

void Program::set(std::string_view uniform, int value) {
  glUniform1i(location(uniform), value);
}
void Program::set(std::string_view uniform, unsigned value) {
  glUniform1ui(location(uniform), value);
}
void Program::set(std::string_view uniform, float value) {
  glUniform1f(location(uniform), value);
}
void Program::set(std::string_view uniform, const vec2& value) {
  glUniform2fv(location(uniform), 1, &value[0]);
}
void Program::set(std::string_view uniform, const vec3& value) {
  glUniform3fv(location(uniform), 1, &value[0]);
}
void Program::set(std::string_view uniform, const vec4& value) {
  glUniform4fv(location(uniform), 1, &value[0]);
}
void Program::set(std::string_view uniform, const mat4& value) {
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, &value[0][0]);
}
void Program::set(std::string_view uniform, const std::vector<vec3>& values) {
  glUniform3fv(location(uniform), GLsizei(values.size()), &values[0][0]);
}

void Program::set(std::string_view uniform, std::span<const vec4> values) {
  if (!values.empty()) glUniform4fv(location(uniform), GLsizei(values.size()), &values[0][0]);
}

void Program::bindBlock(const char* block, unsigned bindingPoint) {
  const unsigned index = glGetUniformBlockIndex(id_, block);
  if (index != GL_INVALID_INDEX) glUniformBlockBinding(id_, index, bindingPoint);
}

}  // namespace catoptric::gl
