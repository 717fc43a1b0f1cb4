// SPDX-License-Identifier: Apache-2.0
// Buffers, textures, framebuffers: what goes in comes out, and misuse by the driver's rules is told.
#include <glad/gl.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/gl/reset_status.h"
#include "gl_test_support.h"

namespace catoptric::gl::test {
namespace {

using ContextTest = GlTest;
using Wrappers = GlTest;

std::string codeOf(const std::function<void()>& body) {
  try {
    body();
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return "nothing was thrown";
}

TEST_F(ContextTest, saysWhatItRunsOn) {
  EXPECT_NE(context().description().find("OpenGL"), std::string::npos) << context().description();
}

TEST_F(ContextTest, anErrorOrAGraveMessageIsThrownOnce) {
  glEnable(0xdead);
  EXPECT_EQ(codeOf([] { context().check("here"); }), "gl.error");
  EXPECT_NO_THROW(context().check("here"));
  for (const GLenum severity : {GL_DEBUG_SEVERITY_HIGH, GL_DEBUG_SEVERITY_MEDIUM}) {
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 1, severity, -1, "grave");
    EXPECT_EQ(codeOf([] { context().check("here"); }), "gl.error");
  }
  glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 1, GL_DEBUG_SEVERITY_LOW, -1,
                       "mild");
  EXPECT_NO_THROW(context().check("here"));
}

unsigned answerGuilty() {
  return GL_GUILTY_CONTEXT_RESET;
}

TEST_F(ContextTest, aResetIsThrownWithItsCauseAndTheNextContextIsSound) {
  EXPECT_EQ(codeOf([] { throwIfReset("window", answerGuilty); }), "gl.lost");
  EXPECT_NO_THROW(throwIfReset("window", nullptr));
  const std::string folder = testing::TempDir() + "catoptric_reset";
  std::filesystem::create_directory(folder);
  setenv("CATOPTRIC_FAKE_GL_RESET", folder.c_str(), 1);
  EXPECT_NO_THROW(context().check("here"));
  std::ofstream(folder + "/renderer").close();
  EXPECT_EQ(codeOf([] { context().check("here"); }), "gl.lost");
  EXPECT_NO_THROW(Context().check("here"));
  unsetenv("CATOPTRIC_FAKE_GL_RESET");
  std::filesystem::remove(folder);
  context().makeCurrent();
}

TEST_F(ContextTest, isToldOfResetsWhereTheDriverOffersIt) {
  GLint strategy = 0;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  if (!GLAD_GL_KHR_robustness) GTEST_SKIP() << "the driver does not tell";
  EXPECT_EQ(strategy, GL_LOSE_CONTEXT_ON_RESET);
}

TEST_F(Wrappers, clearedValuesAreReadBackUnchanged) {
  const Texture color(TextureKind::Flat, Format::Rgba32F, 3, 2, 1, 1, {});
  const Texture ids(TextureKind::Flat, Format::Rg32Ui, 3, 2, 1, 1, {});
  const Texture depth(TextureKind::Flat, Format::Depth32F, 3, 2, 1, 1, {});
  const Framebuffer target(std::array<const Texture*, 2>{&color, &ids}, &depth);
  target.bind();
  const vec4 value(-1.5f, 1e30f, 0.1f, 65504.0f);
  target.clearColor(0, value);
  target.clearColor(1, uvec4(0xffffffffu, 0x80000001u, 0, 0));
  target.clearDepth();
  std::vector<vec4> colors(6);
  std::vector<uvec2> words(6);
  target.readPixels(0, std::span<vec4>(colors));
  target.readPixels(1, std::span<uvec2>(words));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(colors[i], value);
    EXPECT_EQ(words[i], uvec2(0xffffffffu, 0x80000001u));
  }
}

TEST_F(Wrappers, theFirstRowReadIsTheLowestAndBindTurnsTheScissorOff) {
  const FloatTarget target(4, 3);
  target.framebuffer.bind();
  target.framebuffer.clearColor(0, vec4(0));
  setScissor({1, 0, 2, 1});
  target.framebuffer.clearColor(0, vec4(1));
  const std::vector<vec4> pixels = target.read();
  for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_EQ(pixels[i].x, i == 1 || i == 2 ? 1 : 0) << i;
  target.framebuffer.bind();
  target.framebuffer.clearColor(0, vec4(2));
  EXPECT_EQ(target.read().back().x, 2);
}

TEST_F(Wrappers, aTargetThatCannotBeDrawnToIsRefused) {
  const Texture depth(TextureKind::Flat, Format::Depth32F, 4, 4, 1, 1, {});
  EXPECT_EQ(codeOf([&] { const Framebuffer target(std::array<const Texture*, 1>{&depth}, nullptr); }),
            "gl.framebuffer");
  forgetMessages();
}

/// Draws `texture` into a target of its size.
std::vector<vec4> sampleTexture(const Texture& texture, int widthPx, int heightPx, int level) {
  const TestProgram program("screen.vert", "sample.frag");
  const FloatTarget target(widthPx, heightPx);
  const VertexArray nothing;
  target.framebuffer.bind();
  setDrawState({.depthTest = false, .depthWrite = false});
  program.use();
  const int kind = int(texture.kind());
  program.set("u_flat", 0);
  program.set("u_array", 1);
  program.set("u_cube", 2);
  program.set("u_kind", kind);
  program.set("u_level", level);
  program.set("u_widthPx", widthPx);
  program.set("u_heightPx", heightPx);
  texture.bind(kind);
  nothing.bind();
  drawScreen();
  return target.read();
}

TEST_F(Wrappers, texelsAreSampledAsTheyWereUploaded) {
  const std::array<std::uint8_t, 16> bytes{0, 64, 128, 255, 188, 1, 2, 3, 10, 20, 30, 40, 255, 255, 255, 0};
  Texture linear(TextureKind::Flat, Format::Rgba8, 2, 2, 1, 1, {});
  Texture srgb(TextureKind::Flat, Format::Srgb8Alpha8, 2, 2, 1, 1, {});
  linear.upload(0, 0, bytes.data());
  srgb.upload(0, 0, bytes.data());
  const std::vector<vec4> plain = sampleTexture(linear, 2, 2, 0), decoded = sampleTexture(srgb, 2, 2, 0);
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_NEAR(plain[i / 4][int(i % 4)], float(bytes[i]) / 255, 1e-6f) << i;
  // IEC 61966-2-1 of 188/255; drivers may be off by a quarter of a step of 8 bits, llvmpipe is.
  EXPECT_NEAR(decoded[1].x, 0.502886f, 1e-3f);
  EXPECT_NEAR(decoded[1].w, 3.0f / 255.0f, 1e-6f);  // alpha is not decoded
}

TEST_F(Wrappers, levelsLayersAndFacesAreKeptApart) {
  Texture levels(TextureKind::Flat, Format::Rgba16F, 4, 4, 1, 3,
                 {.magnifyNearest = true, .minifyNearest = true, .hasMipmaps = true});
  for (int level = 0; level < 3; ++level)
    levels.upload(level, 0, std::vector<vec4>(std::size_t(16 >> (2 * level)), vec4(float(level))).data());
  for (int level = 0; level < 3; ++level) EXPECT_EQ(sampleTexture(levels, 4, 4, level)[5].x, float(level));
  Texture layers(TextureKind::Array, Format::Rgb16F, 2, 2, 3, 1, {});
  for (int layer = 0; layer < 3; ++layer)
    layers.upload(0, layer, std::vector<vec3>(4, vec3(float(layer) + 0.5f)).data());
  for (int layer = 0; layer < 3; ++layer)
    EXPECT_EQ(sampleTexture(layers, 2, 2, layer)[3].y, float(layer) + 0.5f);
}

TEST_F(Wrappers, framesAreCopiedIntoTheRightFaceOfACube) {
  const Texture cube(TextureKind::Cube, Format::Rgba32F, 4, 4, 1, 1, {});
  const FloatTarget target(4, 4);
  for (int face = 0; face < 6; ++face) {
    target.framebuffer.bind();
    target.framebuffer.clearColor(0, vec4(float(face + 1)));
    target.framebuffer.copyToCubeFace(0, cube, face);
  }
  const std::vector<vec4> seen = sampleTexture(cube, 6, 1, 0);
  for (std::size_t face = 0; face < 6; ++face) EXPECT_EQ(seen[face].x, float(face + 1));
}

TEST_F(Wrappers, generatedLevelsAreTheMean) {
  Texture texture(TextureKind::Flat, Format::Rgba32F, 2, 2, 1, 2, {.hasMipmaps = true});
  texture.upload(0, 0, std::array<vec4, 4>{vec4(0), vec4(1), vec4(2), vec4(5)}.data());
  texture.generateMipmaps();
  EXPECT_NEAR(sampleTexture(texture, 1, 1, 1)[0].x, 2.0f, 1e-6f);
}

/// The clip-space square [x0, x1] x [-1, 1] as four vertices.
std::vector<vec3> makeColumn(float x0, float x1) {
  return {{x0, -1, 0}, {x1, -1, 0}, {x1, 1, 0}, {x0, 1, 0}};
}

TEST_F(Wrappers, buffersFeedDrawsAndCanGrowAndShrink) {
  const TestProgram program("position.vert", "color.frag");
  const FloatTarget target(8, 1);
  Buffer positions(BufferKind::Vertex), colors(BufferKind::Vertex), indices(BufferKind::Index);
  VertexArray array;
  const auto draw = [&](const std::vector<vec3>& p, const vec4& color, const std::vector<std::uint32_t>& i) {
    positions.upload(std::span<const vec3>(p), true);
    colors.upload(std::span<const vec4>(std::vector<vec4>(p.size(), color)));
    indices.upload(std::span<const std::uint32_t>(i));
    array.setAttribute(0, positions, 3);
    array.setAttribute(1, colors, 4);
    array.setIndices(indices);
    target.framebuffer.bind();
    target.framebuffer.clearColor(0, vec4(0));
    setDrawState({.depthTest = false, .depthWrite = false, .cull = Cull::Back});
    program.use();
    array.bind();
    drawTriangles(std::uint32_t(i.size()) - 6, 6);
    return target.read();
  };
  std::vector<vec3> two = makeColumn(-1, 0);
  for (const vec3& p : makeColumn(0, 1)) two.push_back(p);
  EXPECT_EQ(draw(makeColumn(-1, 0), vec4(1), {0, 1, 2, 0, 2, 3})[7].x, 0);
  const std::vector<vec4> right = draw(two, vec4(2), {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7});  // the second six
  EXPECT_EQ(right[0].x, 0);
  EXPECT_EQ(right[7].x, 2);
  const std::vector<vec4> left = draw(makeColumn(-1, 0), vec4(3), {0, 1, 2, 0, 2, 3});
  EXPECT_EQ(left[0].x, 3);
  EXPECT_EQ(left[7].x, 0);
  EXPECT_EQ(draw(makeColumn(-1, 0), vec4(3), {0, 2, 1, 0, 3, 2})[0].x, 0);  // the back is culled
}

TEST_F(Wrappers, blendingIsOfPremultipliedColours) {
  const TestProgram program("position.vert", "color.frag");
  const FloatTarget target(1, 1);
  const std::vector<vec3> square = makeColumn(-1, 1);
  const std::vector<vec4> color(4, vec4(0.25f, 0.5f, 0, 0.5f));
  Buffer positions(BufferKind::Vertex), colors(BufferKind::Vertex), indices(BufferKind::Index);
  positions.upload(std::span<const vec3>(square));
  colors.upload(std::span<const vec4>(color));
  indices.upload(std::span<const std::uint32_t>(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  VertexArray array;
  array.setAttribute(0, positions, 3);
  array.setAttribute(1, colors, 4);
  array.setIndices(indices);
  target.framebuffer.bind();
  target.framebuffer.clearColor(0, vec4(1, 0, 2, 1));
  setDrawState({.depthTest = false, .depthWrite = false, .blend = Blend::Premultiplied});
  program.use();
  array.bind();
  drawTriangles(0, 6);
  EXPECT_EQ(target.read()[0], vec4(0.75f, 0.5f, 1, 1));
}

}  // namespace
}  // namespace catoptric::gl::test
