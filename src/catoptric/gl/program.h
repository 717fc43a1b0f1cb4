// SPDX-License-Identifier: Apache-2.0
// A GLSL program made of the embedded files of shaders/.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::gl {

/// Full text of a shader: #version line, `defines` ("NAME" or "NAME VALUE"), then the file with its #include
/// lines replaced. Throws core::Error("gl.shader") for an unknown file.
[[nodiscard]] std::string assembleShader(std::string_view name, const std::vector<std::string>& defines);

class Program {
 public:
  /// Compiles and links; throws core::Error("gl.shader") with the first line of the driver's log.
  Program(std::string_view vertexFile, std::string_view fragmentFile,
          const std::vector<std::string>& defines = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  /// Setting a uniform that the program does not have is allowed: variants differ. The program must be in
  /// use.
  void set(std::string_view uniform, int value);
  void set(std::string_view uniform, unsigned value);
  void set(std::string_view uniform, float value);
  void set(std::string_view uniform, const vec2& value);
  void set(std::string_view uniform, const vec3& value);
  void set(std::string_view uniform, const vec4& value);
  void set(std::string_view uniform, const mat4& value);
  void set(std::string_view uniform, const std::vector<vec3>& values);
  void set(std::string_view uniform, std::span<const vec4> values);
  /// Connects a uniform block to a binding point (once, after linking).
  void bindBlock(const char* block, unsigned bindingPoint);

 private:
  [[nodiscard]] int location(std::string_view uniform);

  unsigned id_ = 0;
  std::unordered_map<std::string, int> locations_;
};

}  // namespace catoptric::gl
