// SPDX-License-Identifier: Apache-2.0
// Programs: includes are put in, defines come first, and what does not compile is told in one line.
#include "catoptric/gl/program.h"

#include <string>

#include "catoptric/core/error.h"
#include "catoptric/gl/embedded_shaders.h"
#include "gl_test_support.h"

namespace catoptric::gl::test {
namespace {

using ProgramTest = GlTest;

std::size_t countOf(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// The error that a program gives; its text must be one line.
std::string errorOf(const char* vertex, const char* fragment, const std::vector<std::string>& defines = {}) {
  try {
    const Program program(vertex, fragment, defines);
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), "gl.shader");
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(ProgramTest, includesAreReplacedAndDefinesComeFirst) {
  const std::string text = assembleShader("raster/surface.frag", {"OVERLAY", "COUNT 7"});
  EXPECT_EQ(text.rfind("#version 330 core\n", 0), 0u);
  EXPECT_EQ(countOf(text, "#include"), 0u);
  EXPECT_EQ(countOf(text, "vec3 fresnelSchlick("), 1u);        // of lib/brdf.glsl
  EXPECT_EQ(countOf(text, "uniform vec3 u_irradiance["), 1u);  // of raster/material_block.glsl
  EXPECT_LT(text.find("#define OVERLAY\n"), text.find("fresnelSchlick"));
  EXPECT_LT(text.find("#define COUNT 7\n"), text.find("fresnelSchlick"));
}

TEST_F(ProgramTest, aFileThatIsNotThereIsNamed) {
  EXPECT_NE(errorOf("raster/screen.vert", "raster/nothing.frag").find("raster/nothing.frag"),
            std::string::npos);
}

TEST_F(ProgramTest, whatDoesNotCompileOrLinkIsToldWithTheDriversWords) {
  const std::string compile = errorOf("raster/screen.vert", "raster/background.frag", {"main 3"});
  EXPECT_NE(compile.find("does not compile"), std::string::npos) << compile;
  EXPECT_NE(compile.find("rror"), std::string::npos) << compile;
  forgetMessages();
  const std::string link = errorOf("raster/screen.vert", "lib/brdf.glsl");  // no main
  EXPECT_NE(link.find("do not link"), std::string::npos) << link;
}

TEST_F(ProgramTest, aUniformThatAVariantLacksMayBeSet) {
  Program program("raster/surface.vert", "raster/surface.frag");
  program.use();
  program.set("u_noSuchThing", 1.0f);
  program.set("u_noSuchThing", mat4(1));
  program.bindBlock("NoSuchBlock", 3);
}

TEST_F(ProgramTest, everyEmbeddedShaderIsWhole) {
  EXPECT_GT(embeddedShaders().size(), 5u);
  for (const EmbeddedShader& shader : embeddedShaders())
    EXPECT_EQ(countOf(assembleShader(shader.name, {}), "#include"), 0u) << shader.name;
}

}  // namespace
}  // namespace catoptric::gl::test
