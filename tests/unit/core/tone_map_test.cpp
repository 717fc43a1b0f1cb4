// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace catoptric::core {
namespace {

TEST(Srgb, TheTwoHalvesAreInverse) {
  for (int i = 0; i <= 1000; ++i) {
    const float x = float(i) / 1000.0f;
    EXPECT_NEAR(linearFromSrgb(srgbFromLinear(x)), x, 2e-6f);
    EXPECT_NEAR(srgbFromLinear(linearFromSrgb(x)), x, 2e-6f);
  }
  EXPECT_EQ(srgbFromLinear(0.0f), 0.0f);
  EXPECT_NEAR(srgbFromLinear(1.0f), 1.0f, 1e-6f);
  EXPECT_NEAR(srgbFromLinear(0.2140411f), 0.5f, 1e-5f);  // IEC 61966-2-1
}

TEST(Srgb, EveryByteSurvives) {
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(std::lround(srgbFromLinear(linearFromSrgb(float(i) / 255.0f)) * 255.0f), i);
}

TEST(ToneMap, GreyIsMonotoneAndStaysGrey) {
  int last = 0;
  for (float x = 1e-4f; x < 1e5f; x *= 1.03f) {
    const glm::u8vec4 c = toneMap(vec4(x, x, x, 1));
    EXPECT_EQ(c.r, c.g);
    EXPECT_EQ(c.g, c.b);
    EXPECT_GE(int(c.r), last) << x;
    last = c.r;
  }
  EXPECT_GE(last, 254);
}

TEST(ToneMap, BlackStaysBlackAndAlphaPasses) {
  EXPECT_EQ(toneMap(vec4(0, 0, 0, 1)), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(toneMap(vec4(0, 0, 0, 0.5f)).a, 128);
  EXPECT_EQ(toneMap(vec4(1, 1, 1, 1), 0.0f), glm::u8vec4(0, 0, 0, 255));
}

TEST(ToneMap, NotANumberAndNegativeBecomeBlack) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(toneMap(vec4(kNaN, kNaN, kNaN, 1)), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(toneMap(vec4(-5, -0.1f, -1e30f, 1)), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(toneMap(vec4(kNaN, 0.3f, 0.3f, 1)), toneMap(vec4(0, 0.3f, 0.3f, 1)));
}

TEST(ToneMap, InfinityIsWhite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const glm::u8vec4 c = toneMap(vec4(kInfinity, kInfinity, kInfinity, 1));
  EXPECT_GE(int(c.r), 254);
  EXPECT_GE(int(c.b), 254);
}

TEST(ToneMap, ExposureMultiplies) {
  EXPECT_EQ(toneMap(vec4(0.1f, 0.2f, 0.05f, 1), 3.0f), toneMap(vec4(0.3f, 0.6f, 0.15f, 1)));
}

TEST(ToneMap, HighlightsKeepTheOrderOfTheirChannels) {
  const glm::u8vec4 c = toneMap(vec4(6.0f, 3.0f, 1.0f, 1));
  EXPECT_GT(int(c.r), int(c.g));
  EXPECT_GT(int(c.g), int(c.b));
}

TEST(ToneMap, ImageIsThePixelsInOrder) {
  ImageRgbaF linear(37, 23);
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear.data()[i] = vec4(0.001f * float(i), 0.5f, 0.2f, 1.0f);
  const ImageRgba8 mapped = toneMap(linear, 0.7f);
  ASSERT_EQ(mapped.width(), 37);
  ASSERT_EQ(mapped.height(), 23);
  for (std::size_t i = 0; i < linear.size(); ++i)
    EXPECT_EQ(mapped.data()[i], toneMap(linear.data()[i], 0.7f));
}

TEST(ToneMap, BytesAreThoseOfTheFormula) {
  // Greys below the compression: the curve takes off c - 6.25 c^2, from 0.08 on 0.04.
  for (int i = 0; i <= 400000; ++i) {
    const float grey = 0.75f * float(i) / 400000.0f;
    const float taken = grey < 0.08f ? grey - 6.25f * grey * grey : 0.04f;
    const long expected = std::lround(srgbFromLinear(grey - taken) * 255.0f);
    ASSERT_EQ(long(toneMap(vec4(vec3(grey), 1.0f)).g), expected) << grey;
  }
}

}  // namespace
}  // namespace catoptric::core
