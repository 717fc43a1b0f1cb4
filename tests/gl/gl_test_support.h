// SPDX-License-Identifier: Apache-2.0
// What the tests on OpenGL share: a debug context, in which any GL error or message of medium or high
// severity fails the test, and programs made of the files in tests/gl/shaders.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "catoptric/gl/buffer.h"
#include "catoptric/gl/context.h"
#include "catoptric/gl/framebuffer.h"
#include "catoptric/gl/texture.h"

namespace catoptric::gl::test {

class GlTest : public ::testing::Test {
 public:
  /// One context for the whole program.
  static Context& context();

 protected:
  void SetUp() override { context().makeCurrent(); }
  void TearDown() override;
  /// For what a test provokes: the driver has said something grave, or not; either way it is forgotten.
  static void forgetMessages();
};

/// A program of tests/gl/shaders; lines #include "lib/..." are replaced as in the product.
class TestProgram {
 public:
  TestProgram(const std::string& vertexFile, const std::string& fragmentFile);
  ~TestProgram();
  TestProgram(const TestProgram&) = delete;
  TestProgram& operator=(const TestProgram&) = delete;

  void use() const;
  void set(const char* uniform, int value) const;

 private:
  unsigned id_ = 0;
};

/// A render target of 4 floats a pixel.
struct FloatTarget {
  FloatTarget(int widthPx, int heightPx);
  [[nodiscard]] std::vector<vec4> read() const;

  Texture texture;
  Framebuffer framebuffer;
};

}  // namespace catoptric::gl::test
